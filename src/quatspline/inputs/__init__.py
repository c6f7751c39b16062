"""What users hand over, taken as arrays or refused in one sentence."""
