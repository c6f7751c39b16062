"""What one segment is: layouts of constants, with the functions that evaluate them."""
