"""A message filled in as YAML, with a verdict below it as one types, and the field for its type.

Screens and dialogs put `form.YamlForm` and `type_field.TypeField` among their widgets, name the key
of `actions.SubmitForm`, and say why something was not sent by `words.reason_words`. The rest is the
form's own.
"""
