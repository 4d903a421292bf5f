// The twins of family_twins.py, one clock cycle after the other: inputs are set, outputs are read, then the clock rises.
#include <cstring>
#include <memory>
#include "Vtwins.h"

extern "C" void twins(const char *in, char *generic, char *family, long cycles) {
    VerilatedContext context;
    auto top = std::make_unique<Vtwins>(&context);
    constexpr auto size = sizeof top->in;
    for (; cycles; --cycles, in += size, generic += size, family += size) {
        std::memcpy(&top->in, in, size);
        top->clk = 0;
        top->eval();
        std::memcpy(generic, &top->generic, size);
        std::memcpy(family, &top->family, size);
        top->clk = 1;
        top->eval();
    }
}
