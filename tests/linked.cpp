// The circuit of linked.py behind its link, byte by byte: what is due is set, what comes out is read, the clock rises.
#include <memory>
#include "Vlinked.h"

struct Linked {
    VerilatedContext context;
    std::unique_ptr<Vlinked> top = std::make_unique<Vlinked>(&context);

    void cycle() {
        top->clk = 0;
        top->eval();
        top->clk = 1;
        top->eval();
    }
};

extern "C" Linked *linked_new() {
    auto *linked = new Linked;
    linked->top->rst = 1;
    linked->cycle();
    linked->top->rst = 0;
    return linked;
}

extern "C" void linked_delete(Linked *linked) { delete linked; }

// Bytes in, one every ``pause`` cycles; then on for ``cycles``. How many came out, of which the first ``room`` are kept.
extern "C" long linked_run(Linked *linked, const unsigned char *in, long bytes, long pause, long cycles,
                           unsigned char *out, long room) {
    long came = 0;
    for (long cycle = 0; cycle < bytes * pause + cycles; ++cycle) {
        auto &top = *linked->top;
        top.valid = cycle < bytes * pause && cycle % pause == 0;
        if (top.valid) top.data = in[cycle / pause];
        top.clk = 0;
        top.eval();
        if (top.out_valid && came++ < room) *out++ = top.out_data;
        top.clk = 1;
        top.eval();
    }
    return came;
}
