"""The judge: it watches a running profile and says which checks of a step hold.

Others use `judge.Judge`. `evidence` is what it sees of the graph, the log and the processes; there
is a module for each family of checks, and `kinds` says which is for which.
"""
