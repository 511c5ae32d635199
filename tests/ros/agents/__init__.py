"""Tests of `deck mcp` by the client of the MCP SDK, with a real session and real nodes."""
