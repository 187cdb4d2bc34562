"""A motion for people: where to sample it, as curves, as a table, in a few lines of text, in a file.

``units``     what a quantity is measured in, part of its definition; the solvers' numbers and a scene's
``sampling``  times between which forces are straight
``cubic``     cubics between instants at which values and rates are known
``axes``      curves over time or angle, in matplotlib
``frame``     the states of a motion, and the pulses of many scenes, as a table, in pandas
``summary``   text of a screen's length, and the same as HTML
``file``      arrays and a header, written whole and read with care
``same``      equality of values that may be unknown
``whole``     files that are there whole or not at all

Nothing here knows a motion: plain names and arrays come in. matplotlib and pandas are loaded where they are used.
"""
