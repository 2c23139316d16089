"""What is run by hand: `make hostile`, `make fuzz`, `make audit`; the tests take moments of it."""
