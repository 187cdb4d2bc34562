"""What the benchmarks take for true: forty digits for the rigid hoop, all nodes in the limit for the flexible one.

``precision``  the rigid hoop by Taylor series, of which ``precision_values`` keeps what it found
``reference``  runs of all nodes, brought to the limit of fine steps, mesh and contact
"""
