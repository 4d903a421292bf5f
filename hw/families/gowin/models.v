// A behavioural model of the Gowin primitive that hw/families/gowin/blocks.py places, without its own registers and with
// neither pre-adder nor choice of operands: for a linter and a simulator.
module MULT27X36 (
    input [26:0] A, input [35:0] B, input [25:0] D, input [1:0] CLK, CE, RESET, input PSEL, PADDSUB,
    output [62:0] DOUT
);
    assign DOUT = $signed(A) * $signed(B);
    wire unused = &{D, CLK, CE, RESET, PSEL, PADDSUB};
endmodule
