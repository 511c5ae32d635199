"""All topics in a table: `table.TopicsTable`, its columns and their texts, its order.

For the Topics tab only.
"""
