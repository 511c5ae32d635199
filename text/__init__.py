"""What is said and shown, and in which language; every room may import this one, it imports none.

Sentences (`sentences`: made anywhere, translated by who shows them), the language of screen, command
line and nodes (`i18n`), text from outside made harmless (`plain`), numbers (`figures`), what was
probably meant (`suggestions`), what the system and YAML complain of (`os_words`, `yaml_faults`), and
the standard streams (`output`). It needs PyYAML at most, and loads that only with `yaml_faults`.
"""
