"""F = -mu N tanh(v/v_s): a friction law of one's own, as it would stand in ``flexible/contact/laws``."""

from math import inf, sqrt, tanh

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
    normal, by_elastic = 0.0, 0.0
    if load.eta > 0:  # a damper may hold back all that the springs bear
        normal, by_elastic = load.eta * load.elastic, load.eta + load.eta_rate * load.elastic
    shared = Shared(
        load.elastic > 0,
        -law.mu * share * normal,  # F, and its derivatives by the way and by N_el
        -law.mu * (1 - share**2) / law.slip_scale * slip.rate * normal,
        -law.mu * share * by_elastic,
        0.0,
        # how far Newton may go at once; a state looked at by itself has no rate
        sqrt(slip.velocity**2 + law.slip_scale**2) / slip.rate if slip.rate > 0 and load.eta > 0 else inf,
    )
    stuck = foundation.length if abs(slip.velocity) < law.slip_scale else 0.0  # a phase of creep is called rolling
    return Tractions(shared, 0.0, stuck, 0.0, True)


class Tanh(Law):
    name, code = "tanh", CODE
    tractions = staticmethod(tractions)

    @classmethod
    def explanation(cls, friction: Friction) -> str:
        return (
            f"Friction by tanh has no static coefficient: its limit is the rigid hoop with mu_s = mu = {friction.mu:g}."
        )
