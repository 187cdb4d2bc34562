"""What a study takes of the machine it runs on: ``processes`` that work side by side, ``kernels`` compiled for it."""
