"""The harness: scenarios, the episode loop, the runner, the store, metrics, reports and the command line."""
