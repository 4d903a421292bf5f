// The Verilated edge processor alone, for ctypes: a batch of edges per call. sim/backends/edge_bench.py puts the lists
// of ports in front of this file: INPUTS(X) and OUTPUTS(X) have an X(name, bits, cycle) for each port.
#include "Vrheogate_edge.h"
#include "verilated.h"
#include <cstdint>

struct Bench {
    VerilatedContext context;
    Vrheogate_edge top{&context};
    uint64_t noise = 0x9E3779B97F4A7C15;

    // The value of an input in cycles in which no edge is sampled
    uint64_t random() {
        noise ^= noise << 13; noise ^= noise >> 7; noise ^= noise << 17;
        return noise;
    }
    void edge() {
        top.clk = 1; top.eval();
        top.clk = 0; top.eval();
    }
};

static int64_t extended(uint64_t raw, int bits) { return int64_t(raw << (64 - bits)) >> (64 - bits); }

extern "C" {
Bench *bench_new() {
    auto *b = new Bench;
    b->top.valid = 0;
    b->top.reset = 1; b->edge(); b->edge();
    b->top.reset = 0; b->edge();
    return b;
}

void bench_delete(Bench *b) {
    b->top.final();
    delete b;
}

// Words of one of the two damper tables, from address 0 up.
void bench_table(Bench *b, int half, long n, const uint64_t *words) {
    b->top.table_write = 1 << half;
    for (long k = 0; k < n; ++k) {
        b->top.table_address = k;
        b->top.table_data = words[k];
        b->edge();
    }
    b->top.table_write = 0;
}

// entry[cycle]: the row of `vectors` that enters in that cycle, or -1. A row of `results` is written output by output,
// each in its cycle; `faults` gets the fault port of each cycle. The last entries are -1 until the pipeline is empty.
void bench_run(Bench *b, int velocity_shift, long cycles, const int64_t *entry, const int64_t *vectors,
               int64_t *results, uint32_t *faults) {
    auto &top = b->top;
    const auto row = [&](long cycle) { return cycle < 0 ? -1 : entry[cycle]; };
    top.inputs___05Fvelocity_shift = velocity_shift & 0xFF;
    for (long cycle = 0; cycle < cycles; ++cycle) {
        top.valid = entry[cycle] >= 0;
        const int64_t *vector;
        int64_t *result;
        long r;
        int n = 0;
#define X(name, bits, late)                                                                       \
    r = row(cycle - late);                                                                        \
    vector = vectors + r * INPUT_COUNT + n++;                                                     \
    top.name = (r < 0 ? b->random() : uint64_t(*vector)) & ((uint64_t(1) << bits) - 1);
        INPUTS(X)
#undef X
        top.eval();
        n = 0;
#define X(name, bits, late)                                                                       \
    r = row(cycle - late);                                                                        \
    result = results + r * OUTPUT_COUNT + n++;                                                    \
    if (r >= 0) *result = extended(top.name, bits);
        OUTPUTS(X)
#undef X
        faults[cycle] = top.fault;
        b->edge();
    }
}
}
