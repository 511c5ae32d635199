"""Messages as plain trees: installed types, values, YAML forms, conditions, conversion to bytes.

No nodes or subscriptions here: the input is bytes or message objects.
"""
