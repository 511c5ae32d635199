"""The tab of the graph: nodes, services, actions, types, and what can be asked of them.

`screen` holds the list, the detail and the map together. `index` says what is listed, `places`
where one is and was; `detail` has a pane for each kind of thing: `node`, `service`, `action` and
`type`, of which `service` and `action` ask something by a form (`ask`). From outside: `screen` for
the app, and `actions` for what names its keys; the rest is the tab's own.
"""
