"""Verilog of Yosys made readable: plain names, open outputs, complete cases."""

from hw.emit.names import readable

YOSYS = r"""module thing(a, b, clk, wide, d, q);
  reg \$auto$verilog_backend.cc:2355:dump_module$1  = 0;
  wire \$1 ;
  wire [3:0] \$2 ;
  reg [3:0] \$3 ;
  wire \begin ;
  wire alias;
  wire \x$12 ;
  input a;
  wire a;
  input b;
  wire b;
  input clk;
  wire clk;
  input [1:0] d;
  wire [1:0] d;
  output [3:0] q;
  reg [3:0] q = 4'h0;
  output [7:0] wide;
  wire [7:0] wide;
  assign \$1  = ! d;
  assign \begin  = \$1  & \x$12 ;
  assign \x$12  = a ^ b;
  assign \$2  = q + \begin ;
  assign wide = { d[1], d[1], d[1], d[1], d[1], d[1], d };
  always @(posedge clk)
    q <= \$3 ;
  always @* begin
    if (\$auto$verilog_backend.cc:2355:dump_module$1 ) begin end
    \$3  = 4'h0;
    casez (d)
      2'h1:
          \$3  = \$2 ;
    endcase
  end
  assign alias = \x$12 ;
endmodule
"""

READABLE = """module thing(clk, q, a, b, wide, d);
  reg initial_event;
  initial initial_event = 0;
  wire t1;
  wire [3:0] t2;
  reg [3:0] q_next;
  wire begin_;
  wire x_12;
  input a;
  wire a;
  input b;
  wire b;
  input clk;
  wire clk;
  input [1:0] d;
  wire [1:0] d;
  output [3:0] q;
  reg [3:0] q = 4'h0;
  output [7:0] wide;
  wire [7:0] wide;
  assign t1 = ~| d;
  assign begin_ = t1 & x_12;
  assign x_12 = a ^ b;
  assign t2 = q + begin_;
  assign wide = { {6{d[1]}}, d };
  always @(posedge clk)
    q <= q_next;
  always @* begin
    if (initial_event) begin end
    q_next = 4'h0;
    casez (d)
      2'h1:
          q_next = t2;
      default: ;
    endcase
  end
endmodule
"""


def test_verilog_is_made_readable():
    assert readable(YOSYS) == READABLE


def test_readable_text_stays_as_it_is_but_for_the_ports():
    again = readable(READABLE)
    assert again.split("\n", 1)[1] == READABLE.split("\n", 1)[1]


def test_a_name_that_is_taken_is_not_given_again():
    text = YOSYS.replace("alias", "q_next").replace("assign q_next = ", "assign wide[0] = q_next | ")
    assert "q_next_2 = t2;" in readable(text) and "wire q_next;" in readable(text)
