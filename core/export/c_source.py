"""Hold the part of a C header that is the same for every robot: the types, and the torque they stand for."""

TYPES_AND_TORQUE = r"""#ifndef VERITORQUE_INVERSE_DYNAMICS
#define VERITORQUE_INVERSE_DYNAMICS

#include <math.h>

#define VERITORQUE_MOST_LINKS 64

typedef struct {
    const char *name;
    int prismatic;         /* 0: revolute about z, 1: prismatic along z */
    int antecedent;        /* number of the link that carries it, from 1; 0: the base */
    int joint;             /* number of the joint that moves it, from 1 */
    double rotation[9];    /* row by row: from this frame into the antecedent's, at zero coordinate */
    double translation[3]; /* m, in the antecedent's frame */
    double ratio, offset;  /* its angle (rad) or stroke (m) is ratio * q[joint - 1] + offset */
    double inertial[10];   /* XX XY XZ YY YZ ZZ (kg m2, about the frame's origin) MX MY MZ (kg m) M (kg) */
} veritorque_link;

typedef struct {
    const char *name;
    double IA;    /* rotor inertia seen at the joint, kg m2 (prismatic: kg) */
    double FV;    /* viscous friction, N m s/rad (prismatic: N s/m) */
    double FC;    /* Coulomb friction, N m (prismatic: N) */
    double OFF;   /* torque offset, N m (prismatic: N) */
    double width; /* rad/s (m/s): FC acts as FC tanh(dq / width); 0: as FC sign(dq) */
} veritorque_joint;

typedef struct {
    const char *name;
    const double *weights;    /* per joint: the motor turns with the sum of weights[j] * q[j] */
    double IAM, FVM, FCM, width; /* as of a joint, of that sum */
} veritorque_motor;

typedef struct {
    const char *name;
    double gravity[3]; /* acceleration of gravity in the base frame, m/s2 */
    int links, joints, motors;
    const veritorque_link *link;
    const veritorque_joint *joint;
    const veritorque_motor *motor;
} veritorque_robot;

static inline double veritorque_direction(double speed, double width)
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
        const double *lift0 = before < 0 ? up : lift[before], *R = link->rotation, *p = link->inertial;
        const double at = link->ratio * q[own] + link->offset;
        const double speed = link->ratio * dq[own], speeding = link->ratio * ddq[own];
        const double c = link->prismatic ? 1.0 : cos(at), s = link->prismatic ? 0.0 : sin(at);
        double carried[3] = {lift0[0], lift0[1], lift0[2]}, swing[3] = {0.0, 0.0, 0.0};
        for (k = 0; k < 3; ++k) {
            turn[i][3 * k] = R[3 * k] * c + R[3 * k + 1] * s;
            turn[i][3 * k + 1] = R[3 * k + 1] * c - R[3 * k] * s;
            turn[i][3 * k + 2] = R[3 * k + 2];
            shift[i][k] = link->translation[k] + (link->prismatic ? at * R[3 * k + 2] : 0.0);
        }
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
    for (i = robot->links - 1; i >= 0; --i) {
        const veritorque_link *link = &robot->link[i];
        const int before = link->antecedent - 1;
        tau[link->joint - 1] += link->ratio * (link->prismatic ? force[i][2] : moment[i][2]);
        if (before >= 0) {
            double pushed[3];
            for (k = 0; k < 3; ++k) {
                const double *row = &turn[i][3 * k];
                pushed[k] = row[0] * force[i][0] + row[1] * force[i][1] + row[2] * force[i][2];
                force[before][k] += pushed[k];
                moment[before][k] += row[0] * moment[i][0] + row[1] * moment[i][1] + row[2] * moment[i][2];
            }
            veritorque_add_cross(shift[i], pushed, moment[before]);
        }
    }
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

#endif /* VERITORQUE_INVERSE_DYNAMICS */
"""
"""C99 without anything but math.h; it allocates nothing, and two robots' headers may stand in one file."""
