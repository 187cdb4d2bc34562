"""The inner problem in time.

``body``       the rigid hoop as its contact sees it    ``bristles``  the tangential side of the patch
``equations``  forces of the patch, and what they do    ``steps``     explicit ones, and implicit where it is stiff
``run``        the march along them, from event to event
"""
