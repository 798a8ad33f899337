"""Small tests whose right answer is known, the same for every engine: ``scenario`` lists them all."""
