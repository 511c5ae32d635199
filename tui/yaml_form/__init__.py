"""A message entered as YAML and checked during typing, and the field for its type.

Screens and dialogs use `form.YamlForm` and `type_field.TypeField` as widgets, show the key of
`form.submit_form`, and say why something was not sent with `words.reason_words`. Everything else
is internal.
"""
