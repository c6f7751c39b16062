"""What schemes and publications claim, and the probes that measure it."""
