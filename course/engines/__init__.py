"""Real physics engines, run on the reader's own machine.

base        scenes, worlds, an engine's settings, and what an adapter is; adapters has one for each engine
registry    which engines there are, and which of them are installed
scenarios   small tests whose right answer is known
compare     puts engines through scenarios, each in a process of its own (worker)
results     keeps what they gave, and for how long it is true
findings    what follows from the results, in words
reference   one measurement that comes with the course
"""
