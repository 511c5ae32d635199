"""What is wrong with a learner's own file: where, in which line, and what it means.

`source` looks at a file without running it, `crash` reads what a process printed before it ended,
`meanings` has a sentence for each of the usual mistakes of beginners.
"""
