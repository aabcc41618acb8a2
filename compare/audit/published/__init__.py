"""What the papers print, digit by digit, as data: one TOML per paper."""
