"""Where things stand in the flat sequences that the kernels work on, and the codes they exchange.

Inside the kernels R = g = M = 1 with M the total mass; :mod:`rigid.solve` converts at the boundary.
"""

# What does not change during a motion.
ECC, ONE_MINUS_E, GYR, ZETA, MU_S, MU, RESTITUTION, TURNS, T_END, UNTIL = range(10)
PARAMETERS = 10
NOTHING, FIRST_PULSE, REST = range(3)  # values of UNTIL

# The state: the angle as (offset, chart, whole turns), see rigid.kernel.angle; UN and GAP are the normal velocity
# of the contact point and its height, zero on the floor. XDOT and YDOT, the velocity of G, hold while the
# hoop slips or flies: there phidot may be as large as 1/k, and SLIP and UN, which contain it, lose the digits
# that the energy needs.
T, ANGLE, TOP, WHOLE, OMEGA, SLIP, UN, GAP, X_C, XDOT, YDOT = range(11)
MOVING = 11  # numbers of the state that a record keeps
MODE, LAST_KIND, TURNS_DONE, STEPS, RECORDS, PULSES_DONE, PERIOD, STALLS, HOPS = range(11, 20)
# The pulse that is being measured: whether it is open, whether the bottom was crossed, and the state at its
# start.
P_OPEN, P_CROSSED, P_T, P_ANGLE, P_TOP, P_WHOLE, P_XDOT, P_YDOT, P_H, P_ENERGY, P_PEAK, P_T_BOTTOM = range(20, 32)
LOSSLESS_TURNS, SLIDES_DONE, LAST_ENERGY, LAST_TURNS, PHASE_T, SLIP_SCALE, PULL, P_CUT = range(32, 40)
# What a motion without loss is compared with when it comes round: the event (0: none yet), the state there, and how
# many turns, pulses and records there were (see rigid.record.cycle). RECORDED counts all records, RECORDS those in
# the log.
A_EVENT, A_T, A_ANGLE, A_WHOLE, A_OMEGA, A_XDOT, A_X, A_TURNS, A_PULSES, A_RECORDED, RECORDED = range(40, 51)
# The phases of the open pulse, as digits to the base of SEQUENCE_BASE.
P_SEQUENCE = 51
# A slip's start and the time since: where phidot ~ 1/k, sums in T itself would move the angle by their round-off.
T_FROM, T_SINCE = 52, 53
A_KIND = 54  # the phase at the event of A_EVENT
# On a smooth floor: the energy, 0 at rest on top, and the largest term of it (0: not known).
FROM_TOP, TOP_SIZE = 55, 56
# Of a slip that the end of the allowance of steps has cut (HELD): what it goes on with.
HELD, AT_EDGE, P_KNOWN, WHIRLED = range(57, 61)
STATE = 61
SEQUENCE_BASE = 8

# What a phase works in, rows of ORDER + 1 numbers (rigid.kernel.spectral.workspace): Taylor coefficients, for names see
# rigid.phases.slipping.series; a rolling phase keeps its polynomials there.
ORDER = 24
SERIES = 13
S_SIN, S_H, S_OMEGA, S_CO, S_P, S_D, S_B, S_YDOT, S_SLIP, S_T, S_N1, S_PLUS, S_MINUS = range(SERIES)
# Beside it, flat, rows of ROW numbers: values at the nodes of a panel and at its end, for names see
# rigid.phases.slipping.panel, and the tables for them.
NODES = 31
ROW = NODES + 1
(
    Q_X, Q_SIN, Q_H, Q_STRETCH, Q_D, Q_F, Q_LOG, Q_E, Q_OMEGA2, Q_OMEGA, Q_T, Q_SLIP, Q_N1, Q_B, Q_HULL, Q_SHARE,
    Q_NODE, Q_BARY, Q_LAST, Q_NEXT_TO_LAST, Q_NOISE, Q_INTEGRAL,
) = range(0, 22 * ROW, ROW)  # fmt: skip
Q_FROM_TURN, Q_HULL_OF, PANEL_ROOM = (Q_INTEGRAL + i * ROW * ROW for i in range(1, 4))

# Kinds of contact; CHOOSE stands for "find out".
CHOOSE, ROLL, SKID, SPIN, FLIGHT, SKIM, IMPACT = range(7)

# Records of the event log: a phase (tag = its kind) or END carries the state, a TURN the state and its energy, a
# PULSE its measures, a REPEAT what comes again and how often.
WIDTH = 18
TURN_ENERGY = 12  # where in a TURN
PHASE_FROM_TOP, PHASE_TOP_SIZE = 13, 14  # where in the record of a slip
PULSE_CUT, PULSE_SEQUENCE = 16, 17  # where in a PULSE: whether the run begins or ends inside it; its phases
TURN, PULSE, END, REPEAT = 10, 11, 12, 13
# where in a REPEAT: time and place up to which the motion has gone, its period, the way and the whole turns that it
# advances in one, how often it is repeated, and how many turns, pulses and records one period has
R_T, R_PERIOD, R_WAY, R_WHOLE, R_COUNT, R_TURNS, R_PULSES, R_RECORDS = range(1, 9)

# Why a kernel returns.
PHASE_OVER = -1
(
    MORE,
    TURNS_REACHED,
    TIME_REACHED,
    PULSE_OVER,
    ROLLS,
    RESTS,
    SLIDES,
    HITS_FLOOR,
    WORK_BOUND,
    CREEPS,
    LIFTED,
    WHIRLS,
    ROLLS_ON,
    SETTLES,
) = range(14)
