"""A barrier between threads and a clock, for compiled code."""

import ctypes

from numba import njit, types
from numba.extending import intrinsic

SPINS = 2000  # reads of the barrier before the core is offered to another thread; rarely reached unless cores are few
MONOTONIC = 1  # CLOCK_MONOTONIC of Linux, which `time.perf_counter_ns` reads too

_libc = ctypes.CDLL(None)
_clock_gettime, _sched_yield = _libc.clock_gettime, _libc.sched_yield
_clock_gettime.argtypes = ctypes.c_int, ctypes.c_void_p
_sched_yield.argtypes = ()


@intrinsic
def _add(typing, counter, value):
    """Add to counter[0], which all threads see."""

    def generate(context, builder, signature, arguments):
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        return builder.atomic_rmw("add", array.data, arguments[1], "seq_cst")

    return types.int64(counter, types.int64), generate


@intrinsic
def _load(typing, counter):
    """Read counter[0]."""

    def generate(context, builder, signature, arguments):
        array = context.make_array(signature.args[0])(context, builder, arguments[0])
        return builder.load_atomic(array.data, "seq_cst", 8)

    return types.int64(counter), generate


@njit(nogil=True)
def meet(counter, threads, meetings):
    """Wait until all threads are here. Takes and returns the number of meetings so far, 0 at first like counter[0]."""
    if threads > 1:
        _add(counter, 1)
        looks = 0
        while _load(counter) < (meetings + 1) * threads:
            looks += 1
            if looks > SPINS:
                _sched_yield()
    return meetings + 1


@njit(nogil=True)
def stamp(now):
    """Write the time to ``now``: seconds, nanoseconds."""
    _clock_gettime(MONOTONIC, now.ctypes)


@njit(nogil=True)
def idle(stamps):
    """Take stamps and do nothing else, to measure what a stamp costs."""
    for n in range(len(stamps)):
        stamp(stamps[n])
