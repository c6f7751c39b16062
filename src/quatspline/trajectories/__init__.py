"""Motion that is made up: walks, smooth motions, the paper's, hard cases."""
