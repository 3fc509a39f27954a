"""What scripts/bench is made of: studies (YAML), the program they drive, scores, tables and figures."""
