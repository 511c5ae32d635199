"""Messages as plain trees: installed types, values, YAML forms, conditions, conversion to bytes and from them.

No nodes or subscriptions here: the input is bytes or message objects. The rest of `graph` may use
every module. Other rooms may import `types`, `fields`, `making`, `browse`, `condition`, `yaml_form` and `yaml_text`.
"""
