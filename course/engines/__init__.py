"""Real physics engines, run on the reader's own machine.

base        scenes, worlds, an engine's settings, and what an adapter is; adapters has one for each engine
registry    which engines there are, and which of them are installed
scenarios   small tests whose right answer is known
process     starts an engine in a process of its own (worker) and waits with a deadline
compare     puts engines through scenarios; results keeps what they gave, and for how long it is true
findings    what follows from the results, in words
reference   one measurement that comes with the course
"""
