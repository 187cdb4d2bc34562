"""What commands share.

``options``  the options that several have
``results``  the folder that a command writes into: whose it is, and what of an earlier run goes
``single``   one motion run, interrupted where the user asks, written, printed
``tables``   results on the screen, ``account`` the energy ledger among them
``output``   what a run leaves in its folder
``letters``  what is printed where there is no UTF-8
"""
