"""What is run: functions of one sample on quaternions as values, and how they are marked."""
