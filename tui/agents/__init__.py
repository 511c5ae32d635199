"""Agents on the screen: what they ask for, and the person's answer.

`control.AgentControl` answers and ends; `words` says how things stand. There are no widgets here.
"""
