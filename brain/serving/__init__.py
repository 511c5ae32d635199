"""Serving a model file on this machine: llama.cpp in a process of its own.

It may take all the memory there is, and it ends by abort(3) where it finds no other way; so it is
never loaded into a process of Deck's. Deck asks it by HTTP, like any other server.
"""
