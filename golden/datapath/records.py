"""The records that the memories hold, field by field: name -> format. The layout of a memory word, of the host's
image and of the documentation follows from these."""

from golden.datapath.formats import Formats
from golden.numbers.qformat import BIT, Q, unsigned


def material(fmt: Formats, tables: int) -> dict[str, Q]:
    """Coefficients of one material. A value is ``mantissa * 2**-shift``; what they are in SI is in
    `sim.encode.units`."""
    m, e = fmt.mantissa, fmt.exponent
    return {
        "k": m,
        "k_shift": e,
        "c": m,
        "c_shift": e,
        "a_min": fmt.ratio,
        "a_max": fmt.ratio,
        "g1": fmt.threshold,
        "g2": fmt.threshold,
        "rho_low": m,
        "rho_low_shift": e,
        "rho_high": m,
        "rho_high_shift": e,
        "sigma_low": m,
        "sigma_low_shift": e,
        "sigma_high": m,
        "sigma_high_shift": e,
        "force_shift": e,
        "creep_shift": e,
        "first_octave": fmt.octave,
        "fineness": fmt.fineness,
        "table": unsigned(max(1, (tables - 1).bit_length()), 0),
    }


def inverse_word(fmt: Formats) -> dict[str, Q]:
    return {"value": fmt.inverse_value, "slope": fmt.inverse_slope}


def damper_word(fmt: Formats) -> dict[str, Q]:
    """One segment: rho falls and sigma rises with |g|, so both slopes are magnitudes."""
    return {
        f"{quantity}_{part}": getattr(fmt, f"damper_{part}")
        for quantity in ("rho", "sigma")
        for part in ("value", "slope", "shift")
    }


def edge_state(fmt: Formats) -> dict[str, Q]:
    return {"length": fmt.length, "base": fmt.ratio, "ratio": fmt.ratio, "total": fmt.ratio}


def node_state(fmt: Formats) -> dict[str, Q]:
    """Vectors."""
    return {
        "x_base": fmt.position,
        "v_base": fmt.velocity,
        "v": fmt.velocity,
        "x_total": fmt.displacement,
        "v_total": fmt.velocity,
    }


def inverse_mass(fmt: Formats) -> dict[str, Q]:
    return {"value": fmt.mantissa, "shift": fmt.exponent}


def edge_entry() -> dict[str, Q]:
    """An edge in a lane's list: its nodes, whether it is the lane's first on them in a stage, its material. The lists
    of all lanes are equally long; an entry that is not ``valid`` fills up."""
    node, material, bit = unsigned(12, 0), unsigned(6, 0), BIT
    return {"i": node, "j": node, "material": material, "i_first": bit, "j_first": bit, "valid": bit}


def node_entry() -> dict[str, Q]:
    """When a node may be updated: after so many rows of edges, the same number for all that are updated at once; and
    which accumulators then hold a force on it, first ends in the lower bits. An entry that is not ``valid`` fills up.
    """
    return {"need": unsigned(17, 0), "mask": unsigned(16, 0), "valid": BIT}


def width(record: dict[str, Q]) -> int:
    return sum(q.width for q in record.values())


def pack(record: dict[str, Q], fields: dict[str, int]) -> int:
    """The record as one integer, first field lowest.

    Raises
    ------
    ValueError
        If a field does not fit its format.
    """
    word, low = 0, 0
    for name, q in record.items():
        raw = int(fields[name])
        if not q.raw_min <= raw <= q.raw_max:
            raise ValueError(f"{name} must be within {q.raw_min} and {q.raw_max} ({q}), not {raw}")
        word |= (raw & (1 << q.width) - 1) << low
        low += q.width
    return word
