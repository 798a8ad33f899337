"""Real physics engines, run on the reader's own machine.

base.py        scenes, worlds, what an adapter is; adapters/ has one for each engine, options/ what can be set
settings.py    the two kinds of settings of an engine, and what was chosen
registry.py    which engines there are, and which of them are installed
scenarios.py   small tests whose right answer is known
worker.py      the process that an engine runs in; process.py starts it and waits with a deadline
compare.py     puts engines through scenarios; cache.py remembers, reference.json ships one measurement
"""
