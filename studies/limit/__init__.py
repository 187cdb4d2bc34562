"""The limit of infinite stiffness, predicted: where the measures of a pulse tend to, and how fast.

``outer``       how what a layer or a creep changes travels along the rigid motion
``onset``       the start of a slip where friction has no jump
``prediction``  y = L + c eps                      ``compliant``  a rigid ring on a compliant floor, to hold it to
``damping``     how much damping that needs, and where others lead
``study``       the study                          ``summary``    what is told of it     ``figures``  the same drawn
``report``      the same as a page
"""
