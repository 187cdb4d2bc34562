"""`hoop completion SHELL`: what a shell needs to complete commands, options, scenes, keys and fields."""

from __future__ import annotations

import click
from click.shell_completion import get_completion_class

SHELLS = {
    "bash": 'eval "$(hoop completion bash)" in ~/.bashrc',
    "zsh": 'eval "$(hoop completion zsh)" in ~/.zshrc',
    "fish": "hoop completion fish > ~/.config/fish/completions/hoop.fish",
}


@click.command(
    epilog="\b\nOnce and for all:\n" + "\n".join(f"  {shell:5} {line}" for shell, line in SHELLS.items()),
)
@click.argument("shell", type=click.Choice(list(SHELLS)))
@click.pass_context
def completion(ctx: click.Context, shell: str) -> None:
    """Print what makes a shell complete commands, options, scenes, keys and fields."""
    completer = get_completion_class(shell)
    assert completer is not None  # click has all three
    root = ctx.find_root()
    click.echo(completer(root.command, {}, "hoop", "_HOOP_COMPLETE").source())
