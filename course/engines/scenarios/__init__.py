"""Small tests with known right answers, the same for every engine: ``scenario`` lists them all."""
