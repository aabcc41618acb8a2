"""Every table and figure of the five papers that can be made again, printed beside reproduced."""
