"""No family in particular: plain Amaranth, which simulates as it is and leaves the hard blocks to synthesis."""
