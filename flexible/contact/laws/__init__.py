"""Friction laws, a file each.

``law``         what the rest of the program may ask of one
``patch``, ``brush``, ``regularised``
                the laws: tractions and their derivatives in compiled code, what is stored, what sticks, the rigid limit
``listing``     the laws by name, and the one place where compiled code tells them apart

A law of one's own is a file here, its import, entry and branch in ``listing``, and its name in :mod:`rigid.elastic`,
where scenes are checked: compiled code is kept from run to run under the sources that it was made of, and so cannot
take in a function that is handed over while it runs.
"""
