"""The limit of a sequence of measures as stiffness grows, with its uncertainty; of any sequence, it knows of no hoop.

``cases``      which of them say something          ``posterior``  least squares for all coefficients of a series
``series``     the limit where rates are known      ``fitted``     a rate, and the limit where it has to be fitted
``limits``     the limit of a measure, beside the value that it should have
"""
