"""Scenes through solvers, in processes, kept in a folder, whatever the study.

``solvers``   the solvers by name              ``measures``  what is measured on a pulse
``history``   a motion as columns over time    ``case``      one scene through one solver, as a row
``store``     the folder of rows and arrays    ``workers``   cases side by side, on cores or a cluster
``runs``      run once, kept, estimated         ``files``     files written whole or not at all
``progress``  a bar on a terminal
"""
