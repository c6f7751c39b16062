"""What measures a curve: a curve goes in, rows come out."""
