"""The code that runs in the student's process: standard library and NumPy only, copied as a separate package.

worker, zygote, lockdown  the process, the one it is forked from, and what it may not do
loading, loops            a module loaded, and what it may import; marches and folds run where the function is
statements                a module's text, statement by statement, and what its functions need of it
wire                      the language of questions and answers
"""
