"""Three notebooks with their output: ``pulse``, ``limit``, ``hop``. ``python -m studies.notebooks`` runs them again.

They are read as they are, without a kernel, wherever notebooks are shown. Running them needs nbclient and ipykernel,
which the extra ``test`` has.
"""
