"""The records that the memories hold. Each memory's words, the host's image and the documentation follow from these."""

from golden.datapath.formats import Formats
from golden.numbers.qformat import BIT, unsigned
from golden.numbers.record import Record


def material(fmt: Formats, tables: int) -> Record:
    """Return the coefficients of one material; a value is ``mantissa * 2**-shift``. Their units are in
    `sim.encode.units`."""
    m, e = fmt.mantissa, fmt.exponent
    return Record(
        {
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
    )


def inverse_word(fmt: Formats) -> Record:
    """Return a segment of the table of 1 / sqrt(q), which falls: the slope is a magnitude."""
    return Record({"value": fmt.inverse_value, "slope": fmt.inverse_slope})


def damper_word(fmt: Formats) -> Record:
    """Return a segment of a damper table: rho falls and sigma rises with |g|, so both slopes are magnitudes."""
    return Record(
        {
            f"{quantity}_{part}": q
            for quantity in ("rho", "sigma")
            for part, q in (("value", fmt.damper_value), ("slope", fmt.damper_slope), ("shift", fmt.damper_shift))
        }
    )


def edge_state(fmt: Formats) -> Record:
    """Return an edge's natural length, and its ratio as the Runge-Kutta stages need it."""
    return Record({"length": fmt.length, "base": fmt.ratio, "ratio": fmt.ratio, "total": fmt.ratio})


def node_state(fmt: Formats) -> Record:
    """Return a node's state; each field is the format of a vector's components."""
    return Record(
        {
            "x_base": fmt.position,
            "v_base": fmt.velocity,
            "v": fmt.velocity,
            "x_total": fmt.displacement,
            "v_total": fmt.velocity,
        }
    )


def inverse_mass(fmt: Formats) -> Record:
    """Return a node's m_ref / m."""
    return Record({"value": fmt.mantissa, "shift": fmt.exponent})


def edge_entry() -> Record:
    """Return an edge in a lane's list: its nodes, whether it is the lane's first on each of them in a stage, its
    material. The lists of all lanes are equally long, so the last entries may be not ``valid``."""
    node, material, bit = unsigned(12, 0), unsigned(6, 0), BIT
    return Record({"i": node, "j": node, "material": material, "i_first": bit, "j_first": bit, "valid": bit})


def node_entry() -> Record:
    """Return a node in the list of updates: how many rows of edges must be summed first, the same number for all nodes
    updated at once; and which accumulators hold a force on it, first ends in the lower bits. Entries that are not
    ``valid`` fill the last row."""
    return Record({"need": unsigned(17, 0), "mask": unsigned(16, 0), "valid": BIT})
