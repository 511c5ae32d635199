"""The Graph tab: nodes, services, actions, types and findings, with calls, goals and parameters.

`screen` holds the list and the detail together. `index` decides what is listed, and records where the
user is and was. The detail is a `pane` for each kind of thing: `node`, `service`, `action`,
`type` and `finding`; `service` and `action` send something from a form (`ask`). Other rooms import
only `screen` (for the app), `actions` (for the names of its keys) and `index.failures_of`.
"""
