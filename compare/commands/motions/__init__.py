"""Commands about one problem: its fastest motion, its bounds, and motions from elsewhere."""
