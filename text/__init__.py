"""Text for people, and its language; every room imports this one, and it imports none.

It has sentences that are made anywhere and translated where they are shown (`sentences`), the
language of the screen, the command line and the nodes (`i18n`), sanitizing of text from outside
(`plain`), numbers (`figures`), suggestions for mistyped words (`suggestions`), messages about
errors of the system (`os_words`), the standard streams (`output`), the run directory (`run_path`),
which the launcher and the nodes both use, names of ROS (`ros_names`), command lines of `ros2`
(`ros2_words`), and YAML: a reader with rules for each kind of text and its tree (`yaml_tree`),
messages about its errors (`yaml_faults`), the meaning of its scalars (`yaml_scalars`). It needs no library
but PyYAML, and that only for YAML.
"""
