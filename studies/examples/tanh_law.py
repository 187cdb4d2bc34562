"""F = -mu N tanh(v/v_s): a friction law of one's own, as it would stand in ``flexible/contact/laws``."""

from math import sqrt, tanh

from flexible.contact.laws.law import Law
from flexible.contact.points.bristles import keep_touching
from flexible.contact.points.data import Shared, Tractions
from rigid import Friction
from rigid.kernel.compile import loop

CODE = 3


@loop
def tractions(forces, points, foundation, carried, mode, load, slip, law):  # type: ignore[no-untyped-def]
    for i in range(len(carried.stretch)):
        carried.stretch[i] = 0.0  # nothing is stored
    keep_touching(forces.keeps, points.gap)
    share = tanh(slip.velocity / law.slip_scale)
    shared = Shared(
        load.elastic > 0,
        -law.mu * share * load.eta * load.elastic,  # F, and its derivatives by the way and by N_el
        -law.mu * (1 - share**2) / law.slip_scale * slip.rate * load.eta * load.elastic,
        -law.mu * share * (load.eta + load.eta_rate * load.elastic),
        0.0,
        sqrt(slip.velocity**2 + law.slip_scale**2) / slip.rate,  # how far Newton may go at once
    )
    return Tractions(shared, 0.0, 0.0, 0.0, True)


class Tanh(Law):
    name, code = "tanh", CODE
    tractions = staticmethod(tractions)

    @classmethod
    def explanation(cls, friction: Friction) -> str:
        return (
            f"Friction by tanh has no static coefficient: its limit is the rigid hoop with mu_s = mu = {friction.mu:g}."
        )
