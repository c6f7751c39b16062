"""What an operating system and an interpreter ask for: whole files, locks, imports, forks."""
