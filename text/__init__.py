"""What is said and shown, and in which language: every room imports this one, it imports none.

Sentences (`sentences`: made anywhere, translated by who shows them), the language of the screen,
the command line and the nodes (`i18n`), text from outside made harmless (`plain`), numbers
(`figures`), what was probably meant (`suggestions`), what the system and YAML complain of
(`os_words`, `yaml_faults`), what a word of YAML stands for (`yaml_scalars`), the standard streams
(`output`). It needs PyYAML at most, and that only for YAML.
"""
