"""What the benchmarks take for true: forty digits for the rigid hoop, all nodes in the limit for the flexible one."""
