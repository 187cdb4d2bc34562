"""What commands share.

``options``  the options that several have, and the folder that a command writes into
``tables``   results on the screen, ``account`` the energy ledger among them
``output``   what a run leaves in its folder
"""
