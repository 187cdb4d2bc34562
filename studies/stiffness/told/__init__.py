"""What is told of a stiffness study; the screen and the page print the same.

``rows``     tables' rows          ``sentences``  the answer in words, and how it was found
``figures``  drawn                 ``report``     all of it as a page
"""
