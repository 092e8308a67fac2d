"""Hold what a C header computes with its types, as text: controllers need no library.

It is the same for every robot.
"""

DYNAMICS = r"""static inline double veritorque_direction(double speed, double width)
{
    return width > 0.0 ? tanh(speed / width) : (double)((speed > 0.0) - (speed < 0.0));
}

static inline void veritorque_add_cross(const double *a, const double *b, double *sum)
{
    sum[0] += a[1] * b[2] - a[2] * b[1];
    sum[1] += a[2] * b[0] - a[0] * b[2];
    sum[2] += a[0] * b[1] - a[1] * b[0];
}

static inline void veritorque_add_inertia(const double *p, const double *v, double *sum)
{
    sum[0] += p[0] * v[0] + p[1] * v[1] + p[2] * v[2];
    sum[1] += p[1] * v[0] + p[3] * v[1] + p[4] * v[2];
    sum[2] += p[2] * v[0] + p[4] * v[1] + p[5] * v[2];
}

/* A link's frame in its antecedent's, at the coordinates q: rotation row by row, and position in m. */
static inline void veritorque_place(const veritorque_link *link, const double *q, double *turn, double *shift)
{
    const double at = link->ratio * q[link->joint - 1] + link->offset, *R = link->rotation;
    const double c = link->prismatic ? 1.0 : cos(at), s = link->prismatic ? 0.0 : sin(at);
    int k;

    for (k = 0; k < 3; ++k) {
        turn[3 * k] = R[3 * k] * c + R[3 * k + 1] * s;
        turn[3 * k + 1] = R[3 * k + 1] * c - R[3 * k] * s;
        turn[3 * k + 2] = R[3 * k + 2];
        shift[k] = link->translation[k] + (link->prismatic ? at * R[3 * k + 2] : 0.0);
    }
}

/* Turn a vector from a link's frame into its antecedent's. */
static inline void veritorque_turn(const double *turn, const double *v, double *turned)
{
    int k;

    for (k = 0; k < 3; ++k)
        turned[k] = turn[3 * k] * v[0] + turn[3 * k + 1] * v[1] + turn[3 * k + 2] * v[2];
}

/* Add a link's force and moment, in its frame and about its origin, to its antecedent's. */
static inline void veritorque_carry(const double *turn, const double *shift, const double *force,
                                    const double *moment, double *force0, double *moment0)
{
    double pushed[3], twisted[3];
    int k;

    veritorque_turn(turn, force, pushed);
    veritorque_turn(turn, moment, twisted);
    for (k = 0; k < 3; ++k) {
        force0[k] += pushed[k];
        moment0[k] += twisted[k];
    }
    veritorque_add_cross(shift, pushed, moment0);
}

/* Add to tau what the links ask of their joints, from tip to base: each carries those behind it as well. */
static inline void veritorque_inward(const veritorque_robot *robot, double turn[][9], double shift[][3],
                                     double force[][3], double moment[][3], double *tau)
{
    int i;

    for (i = robot->links - 1; i >= 0; --i) {
        const veritorque_link *link = &robot->link[i];
        const int before = link->antecedent - 1;
        tau[link->joint - 1] += link->ratio * (link->prismatic ? force[i][2] : moment[i][2]);
        if (before >= 0)
            veritorque_carry(turn[i], shift[i], force[i], moment[i], force[before], moment[before]);
    }
}

/* Joint torque (N m; prismatic: N) of a motion: q (rad, m), dq and ddq per second; one number per joint each.
   Recursive Newton-Euler: Luh, Walker & Paul 1980; rotors, friction and offsets are added joint by joint. */
static inline void veritorque_inverse_dynamics(const veritorque_robot *robot, const double *q,
                                               const double *dq, const double *ddq, double *tau)
{
    double turn[VERITORQUE_MOST_LINKS][9], shift[VERITORQUE_MOST_LINKS][3];
    double spin[VERITORQUE_MOST_LINKS][3], rate[VERITORQUE_MOST_LINKS][3], lift[VERITORQUE_MOST_LINKS][3];
    double force[VERITORQUE_MOST_LINKS][3], moment[VERITORQUE_MOST_LINKS][3];
    const double still[3] = {0.0, 0.0, 0.0};
    const double up[3] = {-robot->gravity[0], -robot->gravity[1], -robot->gravity[2]};
    int i, j, k;

    for (i = 0; i < robot->links; ++i) {
        const veritorque_link *link = &robot->link[i];
        const int before = link->antecedent - 1, own = link->joint - 1;
        const double *spin0 = before < 0 ? still : spin[before], *rate0 = before < 0 ? still : rate[before];
        const double *lift0 = before < 0 ? up : lift[before], *p = link->inertial;
        const double speed = link->ratio * dq[own], speeding = link->ratio * ddq[own];
        double carried[3] = {lift0[0], lift0[1], lift0[2]}, swing[3] = {0.0, 0.0, 0.0};
        veritorque_place(link, q, turn[i], shift[i]);
        veritorque_add_cross(spin0, shift[i], swing);
        veritorque_add_cross(rate0, shift[i], carried);
        veritorque_add_cross(spin0, swing, carried);
        for (k = 0; k < 3; ++k) {
            spin[i][k] = turn[i][k] * spin0[0] + turn[i][3 + k] * spin0[1] + turn[i][6 + k] * spin0[2];
            rate[i][k] = turn[i][k] * rate0[0] + turn[i][3 + k] * rate0[1] + turn[i][6 + k] * rate0[2];
            lift[i][k] = turn[i][k] * carried[0] + turn[i][3 + k] * carried[1] + turn[i][6 + k] * carried[2];
        }
        if (link->prismatic) {
            lift[i][0] += 2.0 * spin[i][1] * speed;
            lift[i][1] -= 2.0 * spin[i][0] * speed;
            lift[i][2] += speeding;
        } else {
            rate[i][0] += spin[i][1] * speed;
            rate[i][1] -= spin[i][0] * speed;
            rate[i][2] += speeding;
            spin[i][2] += speed;
        }
        {
            double pull[3] = {0.0, 0.0, 0.0}, whirl[3] = {0.0, 0.0, 0.0};
            for (k = 0; k < 3; ++k) {
                force[i][k] = p[9] * lift[i][k];
                moment[i][k] = 0.0;
            }
            veritorque_add_cross(spin[i], p + 6, pull);
            veritorque_add_cross(rate[i], p + 6, force[i]);
            veritorque_add_cross(spin[i], pull, force[i]);
            veritorque_add_inertia(p, spin[i], whirl);
            veritorque_add_inertia(p, rate[i], moment[i]);
            veritorque_add_cross(spin[i], whirl, moment[i]);
            veritorque_add_cross(p + 6, lift[i], moment[i]);
        }
    }
    for (j = 0; j < robot->joints; ++j) {
        const veritorque_joint *drive = &robot->joint[j];
        tau[j] = drive->IA * ddq[j] + drive->FV * dq[j]
                 + drive->FC * veritorque_direction(dq[j], drive->width) + drive->OFF;
    }
    veritorque_inward(robot, turn, shift, force, moment, tau);
    for (i = 0; i < robot->motors; ++i) {
        const veritorque_motor *motor = &robot->motor[i];
        double speed = 0.0, speeding = 0.0, torque;
        for (j = 0; j < robot->joints; ++j) {
            speed += motor->weights[j] * dq[j];
            speeding += motor->weights[j] * ddq[j];
        }
        torque = motor->IAM * speeding + motor->FVM * speed
                 + motor->FCM * veritorque_direction(speed, motor->width);
        for (j = 0; j < robot->joints; ++j)
            tau[j] += motor->weights[j] * torque;
    }
}

/* Joint torque (N m; prismatic: N) that holds the bodies at rest at q, without friction and offsets. */
static inline void veritorque_gravity(const veritorque_robot *robot, const double *q, double *tau)
{
    double turn[VERITORQUE_MOST_LINKS][9], shift[VERITORQUE_MOST_LINKS][3];
    double lift[VERITORQUE_MOST_LINKS][3], force[VERITORQUE_MOST_LINKS][3], moment[VERITORQUE_MOST_LINKS][3];
    const double up[3] = {-robot->gravity[0], -robot->gravity[1], -robot->gravity[2]};
    int i, j, k;

    for (i = 0; i < robot->links; ++i) {
        const veritorque_link *link = &robot->link[i];
        const double *lift0 = link->antecedent ? lift[link->antecedent - 1] : up, *p = link->inertial;
        veritorque_place(link, q, turn[i], shift[i]);
        for (k = 0; k < 3; ++k) {
            lift[i][k] = turn[i][k] * lift0[0] + turn[i][3 + k] * lift0[1] + turn[i][6 + k] * lift0[2];
            force[i][k] = p[9] * lift[i][k];
            moment[i][k] = 0.0;
        }
        veritorque_add_cross(p + 6, lift[i], moment[i]);
    }
    for (j = 0; j < robot->joints; ++j)
        tau[j] = 0.0;
    veritorque_inward(robot, turn, shift, force, moment, tau);
}

/* Add to a composite body (XX XY XZ YY YZ ZZ MX MY MZ M) that of a link it carries, in its frame. */
static inline void veritorque_add_body(const double *turn, const double *shift, const double *b, double *sum)
{
    const double tensor[9] = {b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5]};
    const double *d = shift, m = b[9];
    double moment[3], half[9], h0, h1, h2;
    int i, k;

    veritorque_turn(turn, b + 6, moment);
    for (i = 0; i < 3; ++i)
        for (k = 0; k < 3; ++k)
            half[3 * i + k] = turn[3 * i] * tensor[k] + turn[3 * i + 1] * tensor[3 + k]
                              + turn[3 * i + 2] * tensor[6 + k];
#define VERITORQUE_TURNED(i, k) \
    (half[3 * i] * turn[3 * k] + half[3 * i + 1] * turn[3 * k + 1] + half[3 * i + 2] * turn[3 * k + 2])
    h0 = 2.0 * moment[0] + m * d[0];
    h1 = 2.0 * moment[1] + m * d[1];
    h2 = 2.0 * moment[2] + m * d[2];
    sum[0] += VERITORQUE_TURNED(0, 0) + d[1] * h1 + d[2] * h2;
    sum[1] += VERITORQUE_TURNED(0, 1) - d[0] * (moment[1] + m * d[1]) - d[1] * moment[0];
    sum[2] += VERITORQUE_TURNED(0, 2) - d[0] * (moment[2] + m * d[2]) - d[2] * moment[0];
    sum[3] += VERITORQUE_TURNED(1, 1) + d[0] * h0 + d[2] * h2;
    sum[4] += VERITORQUE_TURNED(1, 2) - d[1] * (moment[2] + m * d[2]) - d[2] * moment[1];
    sum[5] += VERITORQUE_TURNED(2, 2) + d[0] * h0 + d[1] * h1;
#undef VERITORQUE_TURNED
    for (k = 0; k < 3; ++k)
        sum[6 + k] += moment[k] + m * d[k];
    sum[9] += m;
}

/* Inertia matrix at q with rotors and motors, row by row: joints * joints numbers, kg m2 (prismatic: kg).
   Composite rigid bodies: Walker & Orin 1982. */
static inline void veritorque_inertia_matrix(const veritorque_robot *robot, const double *q, double *M)
{
    double turn[VERITORQUE_MOST_LINKS][9], shift[VERITORQUE_MOST_LINKS][3], body[VERITORQUE_MOST_LINKS][10];
    const int n = robot->joints;
    int i, j, k, at;

    for (k = 0; k < n * n; ++k)
        M[k] = 0.0;
    for (i = 0; i < robot->links; ++i) {
        veritorque_place(&robot->link[i], q, turn[i], shift[i]);
        for (k = 0; k < 10; ++k)
            body[i][k] = robot->link[i].inertial[k];
    }
    for (i = robot->links - 1; i >= 0; --i) {
        const veritorque_link *link = &robot->link[i];
        const double *b = body[i];
        double force[3], moment[3], own;
        if (link->antecedent)
            veritorque_add_body(turn[i], shift[i], b, body[link->antecedent - 1]);
        /* What a unit acceleration along or about the link's axis asks for. */
        force[0] = link->prismatic ? 0.0 : -b[7];
        force[1] = link->prismatic ? 0.0 : b[6];
        force[2] = link->prismatic ? b[9] : 0.0;
        moment[0] = link->prismatic ? b[7] : b[2];
        moment[1] = link->prismatic ? -b[6] : b[4];
        moment[2] = link->prismatic ? 0.0 : b[5];
        own = link->prismatic ? force[2] : moment[2];
        M[(link->joint - 1) * (n + 1)] += link->ratio * link->ratio * own;
        for (at = i; robot->link[at].antecedent; ) {
            double pushed[3] = {0.0, 0.0, 0.0}, twisted[3] = {0.0, 0.0, 0.0}, torque;
            const veritorque_link *carrier = &robot->link[robot->link[at].antecedent - 1];
            veritorque_carry(turn[at], shift[at], force, moment, pushed, twisted);
            for (k = 0; k < 3; ++k) {
                force[k] = pushed[k];
                moment[k] = twisted[k];
            }
            at = robot->link[at].antecedent - 1;
            torque = link->ratio * carrier->ratio * (carrier->prismatic ? force[2] : moment[2]);
            M[(link->joint - 1) * n + carrier->joint - 1] += torque;
            M[(carrier->joint - 1) * n + link->joint - 1] += torque;
        }
    }
    for (j = 0; j < n; ++j)
        M[j * (n + 1)] += robot->joint[j].IA;
    for (i = 0; i < robot->motors; ++i)
        for (j = 0; j < n; ++j)
            for (k = 0; k < n; ++k)
                M[j * n + k] += robot->motor[i].IAM * robot->motor[i].weights[j] * robot->motor[i].weights[k];
}
"""
"""C99 without anything but math.h; it allocates nothing, and two robots' headers may stand in one file."""
