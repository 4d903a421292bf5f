// The Verilated circuit behind its host port, for ctypes: whole batches of requests and whole runs per call.
#include "Vrheogate.h"
#include "verilated.h"
#ifdef TRACE_VCD
#include "verilated_vcd_c.h"
using Trace = VerilatedVcdC;
#endif
#ifdef TRACE_FST
#include "verilated_fst_c.h"
using Trace = VerilatedFstC;
#endif
#include <cstdint>

constexpr long RECORDED_CYCLES = 5000;  // of waveforms, from the first run on: about 40 kB a cycle as VCD

struct Circuit {
    VerilatedContext context;
    Vrheogate top{&context};
    uint64_t cycles = 0;
#if defined(TRACE_VCD) || defined(TRACE_FST)
    Trace trace;
    long recorded = 0;  // cycles, twice: each half is dumped; a run starts it
    bool running = false;
    void dump(int half) {
        if (running && recorded < 2 * RECORDED_CYCLES) { trace.dump(10 * cycles + 5 * half); ++recorded; }
    }
#else
    void dump(int) {}
#endif
    void tick() {
        top.clk = 1; top.eval(); dump(0);
        top.clk = 0; top.eval(); dump(1);
        ++cycles;
    }
};

extern "C" {
Circuit *circuit_new(const char *waves) {
    auto *c = new Circuit;
#if defined(TRACE_VCD) || defined(TRACE_FST)
    c->context.traceEverOn(true);
    c->top.trace(&c->trace, 99);
    c->trace.open(waves);
#else
    (void)waves;
#endif
    return c;
}

void circuit_delete(Circuit *c) {
#if defined(TRACE_VCD) || defined(TRACE_FST)
    c->trace.close();
#endif
    c->top.final();
    delete c;
}

void circuit_reset(Circuit *c) {
    c->top.request = 0;
    c->top.rst = 1; c->tick(); c->tick();
    c->top.rst = 0; c->tick();
}

uint64_t circuit_cycles(Circuit *c) { return c->cycles; }

// One request a cycle; returns how many answers came (all of them, unless the circuit is broken).
long circuit_transact(Circuit *c, long n, const uint32_t *address, const uint64_t *data, const uint8_t *write,
                      uint64_t *answer, uint8_t *error) {
    long sent = 0, got = 0;
    for (long cycle = 0; got < n && cycle < n + 1000; ++cycle) {
        c->top.request = sent < n;
        if (sent < n) {
            c->top.address = address[sent];
            c->top.write_data = data[sent];
            c->top.write = write[sent];
            ++sent;
        }
        c->tick();
        if (c->top.answer) {
            answer[got] = c->top.read_data;
            error[got++] = c->top.error;
        }
    }
    c->top.request = 0;
    return got;
}

// Ticks while the circuit is busy, at most so many cycles; returns whether it still is.
int circuit_wait(Circuit *c, long most) {
#if defined(TRACE_VCD) || defined(TRACE_FST)
    c->running = true;
#endif
    for (long k = 0; k < most && c->top.busy; ++k) c->tick();
    return c->top.busy;
}
}
