"""From recorded episodes to numbers, tables and plots."""
