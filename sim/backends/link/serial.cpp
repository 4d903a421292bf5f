// The Verilated circuit behind its link, for ctypes: bits on the serial pins, made and read here without the circuit's
// own receiver and transmitter.
#include "Vrheogate_linked.h"
#include "verilated.h"
#include <cstdint>
#include <deque>

struct Serial {
    VerilatedContext context;
    Vrheogate_linked top{&context};
    double bit_in;            // cycles of a bit that goes in: a host's rate is never quite the circuit's
    int bit_out;              // and of one that comes out
    std::deque<uint8_t> in;
    double begun = 0;         // the cycle in which the byte that goes in began
    bool sending = false;
    int reading = -1;         // cycles since the start bit of the byte that comes out, or none
    uint8_t byte = 0;
    uint64_t cycle = 0;

    void drive() {
        if (sending && cycle - begun >= 10 * bit_in) sending = false, in.pop_front(), begun += 10 * bit_in;
        if (!sending && !in.empty()) {
            sending = true;
            if (cycle - begun > bit_in) begun = cycle;  // the line was idle
        }
        const int bit = sending ? int((cycle - begun) / bit_in) : 9;
        top.rx = bit <= 0 ? 0 : bit >= 9 ? 1 : in.front() >> (bit - 1) & 1;
    }
    // Whether a whole byte has come
    bool sample() {
        if (reading < 0) {
            if (!top.tx) reading = 0;
            return false;
        }
        const int bit = ++reading / bit_out;
        if (reading % bit_out != bit_out / 2) return false;
        if (bit >= 1 && bit <= 8) byte = byte >> 1 | top.tx << 7;
        if (bit == 9) reading = -1;
        return bit == 9;
    }
};

extern "C" {
Serial *serial_new(double bit_in, int bit_out) {
    auto *s = new Serial;
    s->bit_in = bit_in;
    s->bit_out = bit_out;
    s->top.rx = 1;
    for (int half = 0; half < 8; ++half) {
        s->top.rst = half < 6;
        s->top.clk = half & 1;
        s->top.eval();
    }
    return s;
}

void serial_delete(Serial *s) {
    s->top.final();
    delete s;
}

void serial_reset(Serial *s) {
    s->top.rst = 1;
    for (int half = 0; half < 4; ++half) s->top.clk = half & 1, s->top.eval();
    s->top.rst = 0;
}

uint64_t serial_cycles(Serial *s) { return s->cycle; }

// Whether the line is idle both ways and no steps are run.
int serial_idle(Serial *s) { return s->in.empty() && s->reading < 0 && !s->top.busy; }

// So many bytes more go in; runs so many cycles; returns how many bytes came out, at most ``room``.
long serial_run(Serial *s, const uint8_t *in, long bytes, long cycles, uint8_t *out, long room) {
    s->in.insert(s->in.end(), in, in + bytes);
    long came = 0;
    for (long k = 0; k < cycles && came < room; ++k) {
        s->drive();
        s->top.clk = 1; s->top.eval();
        if (s->sample()) out[came++] = s->byte;
        s->top.clk = 0; s->top.eval();
        ++s->cycle;
    }
    return came;
}
}
