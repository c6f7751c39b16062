"""How functions of kernels are run: plain Python at once, machine code once it repays compiling."""
