"""The README's pictures and numbers, each with the command that makes it: ``python -m studies.readme``.

``stated``  what there is
``again``   the commands run, the pictures made anew, the numbers compared

For developers: it needs a checkout.
"""
