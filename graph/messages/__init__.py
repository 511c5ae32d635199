"""Messages as plain trees: types as installed, values, YAML forms, conditions, from and to bytes.

No node and no subscription here: what comes in are bytes or message objects.
"""
