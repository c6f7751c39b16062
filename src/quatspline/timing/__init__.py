"""What a scheme costs: interleaved seconds, forecasts, counted operations."""
