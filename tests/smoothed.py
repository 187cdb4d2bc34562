"""The rigid hoop under friction that is smoothed by a velocity, by scipy."""

from math import cos, sin, sqrt

from scipy.integrate import solve_ivp

import rigid


def with_a_point(scene, scale, ends, rtol=1e-9):
    """J_F, J_N and loss between two angles of a rigid hoop that touches with a point, F = -mu N v/sqrt(v^2 + v_s^2).

    It is released as it creeps: R = m = g = 1, M = 1 + m_h/m, B = 1 + e cos phi, and with f = F/N

        phi'' = N (e sin phi - f B)/(K M),   N (1 + e sin phi (e sin phi - f B)/K) = M (1 - e phi'^2 cos phi),
        v' = F/M - B phi'' + e phi'^2 sin phi.
    """
    hoop, mu = scene.hoop, scene.friction.mu
    mass, e, gyration = 1 + hoop.mass_ratio, hoop.e, hoop.K
    start = rigid.simulate(scene).at(0.0)

    def rates(_, y):
        phi, omega, v = y[:3]
        pull, s, arm = -mu * v / sqrt(v * v + scale * scale), e * sin(phi), 1 + e * cos(phi)
        normal = mass * (1 - (arm - 1) * omega**2) / (1 + s * (s - pull * arm) / gyration)
        alpha = normal * (s - pull * arm) / (gyration * mass)
        slips = pull * normal / mass - alpha * arm + s * omega**2
        return [omega, alpha, slips, pull * normal, normal, -pull * normal * v]

    def passes(phi):
        return lambda _, y: y[0] - phi

    last = passes(ends[1])
    last.terminal = True
    used = -start.friction_force / (mu * start.normal_force)
    begins = [start.phi, start.omega, scale * used / sqrt(1 - used**2), 0.0, 0.0, 0.0]
    events = [passes(ends[0]), last]
    found = solve_ivp(rates, (0.0, 30.0), begins, "LSODA", events=events, rtol=rtol, atol=1e-3 * rtol)
    return (found.y_events[1][0] - found.y_events[0][0])[3:]
