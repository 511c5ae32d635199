"""Hearing and speaking: utterances out of a microphone, words out of them, voices for answers.

Sound is PCM as in `robot.sound`: 16-bit little-endian samples, one channel. Each file that needs a
library of its own imports it when it is used, and says which one is missing: `speech.faults`.
"""
