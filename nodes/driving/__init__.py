"""Driving to a point, and driving for a while: goals, repetition, words.

For the nodes that drive: `drive_to_point`, `llm_parser` and `ai_driver`.
"""
