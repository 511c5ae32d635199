"""All topics in a table: `table.TopicsTable`, its columns and their texts, its order."""
