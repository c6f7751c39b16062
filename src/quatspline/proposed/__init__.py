"""The paper's quartic, and what this project adds."""
