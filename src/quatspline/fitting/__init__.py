"""From keyframes to the constants of segments."""
