"""Messages as plain trees: types as installed, values, YAML forms, conditions, from bytes and back.

No node and no subscription here: what comes in are bytes or message objects.
"""
