"""What recognises the usual mistakes, in the order in which it is asked."""

from __future__ import annotations

from launcher.faults.failure import Rule
from launcher.faults.rules import attributes, callbacks, calls, fields, names, said, values

RULES: tuple[Rule, ...] = (
    # What rclpy has called, and what it was given back, before what its own lines seem to say.
    callbacks.signature, callbacks.response, callbacks.swapped, callbacks.done,
    # A letter of another alphabet, before all that would call its name unknown.
    names.alphabet,
    # Messages know themselves what their fields take.
    fields.result, fields.field_value, fields.not_made, fields.sent, fields.hollow, fields.unknown_field,
    fields.positional_field, fields.feedback,
    # What rclpy's functions were given, before the exceptions that they raise for it.
    calls.spun, calls.made, calls.parameters,
    # What an exception says by itself.
    said.rows, said.undeclared, said.bad_name, said.spun_twice, said.two_types, said.looked_up, said.opencv,
    calls.logger, calls.misused, calls.text_for_number,
    names.not_found, names.misplaced,
    names.local, names.unknown,
    attributes.other_names, attributes.unsettable, attributes.missing,
    # The learner's own line: its classes, its operators, its calls, its values.
    calls.of_super, calls.base, calls.unwritten_init,
    values.formatted, values.operands, values.not_callable, values.not_indexable,
    calls.arguments, values.builtin, values.not_iterable,
    values.number, values.unpacked, values.index, values.key, values.zero,
    # Nothing more is known than that something is None.
    values.missing_value,
)  # fmt: skip
