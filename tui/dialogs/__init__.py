"""Dialogs and pages that belong to no tab."""
