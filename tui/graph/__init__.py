"""The Graph tab: nodes, services, actions and types, with calls, goals and parameters.

`screen` holds the list, the detail and the map together. `index` decides what is listed, and
`places` records where the user is and was. `detail` has a pane for each kind of thing: `node`,
`service`, `action` and `type`; `service` and `action` send something from a form (`ask`). Other
rooms import only `screen` (for the app) and `actions` (for the names of its keys).
"""
