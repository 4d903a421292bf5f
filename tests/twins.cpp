// The twins of ecp5_twins.py, one clock cycle after the other: inputs are set, outputs are read, then the clock rises.
#include <cstring>
#include <memory>
#include "Vtwins.h"

extern "C" void twins(const char *in, char *generic, char *ecp5, long cycles) {
    VerilatedContext context;
    auto top = std::make_unique<Vtwins>(&context);
    constexpr auto size = sizeof top->in;
    for (; cycles; --cycles, in += size, generic += size, ecp5 += size) {
        std::memcpy(&top->in, in, size);
        top->clk = 0;
        top->eval();
        std::memcpy(generic, &top->generic, size);
        std::memcpy(ecp5, &top->ecp5, size);
        top->clk = 1;
        top->eval();
    }
}
