"""Noticing, inside a learner's node, what keeps it from its work, by the stacks of its threads.

It needs nothing of rclpy, and no part of Deck: the learner may have a `launcher` of his own, so
`launcher.node_program` imports this under another name.

A callback is stuck if it waits for what only its own thread could bring, or if it does not return
for so long that nobody would wait for it. In a pool it is stuck if it waits for an answer that its
callback group, or the pool, takes in only after it; so is a coroutine that awaits one. The main
thread is stuck if it does not come to spin a node that waits for that. Whoever waits for an answer
is stuck if nobody offers the service or action, or did when the request was sent. A node is
forsaken if it has been taken out of its executor by another one that does not spin.

Time in which the watching thread did not run either does not count: whoever stops the process, or a
machine without time for it, makes nobody stuck; nor does a debugger.
"""
