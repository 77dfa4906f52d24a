/* Laws for tests/plastic/test_compiled.py. SPDX-License-Identifier: BSD-3-Clause */
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Mises plasticity with linear hardening (E, nu, yield stress, slope) in plane strain by radial return;
   linear elasticity in plane stress. STATEV: plastic strain 11 22 33 12, equivalent plastic strain. */
static void steel(double *s, double *v, double *d, double *sse, double *spd, const double *e,
                  const double *de, const double *props, int n)
{
    double E = props[0], nu = props[1], G = E / (2 * (1 + nu)), K = E / (3 * (1 - 2 * nu));
    double lame = n == 3 ? E * nu / (1 - nu * nu) : K - 2 * G / 3, c[4][4];
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            c[i][j] = (i < n - 1 && j < n - 1 ? lame : 0) +
                      (i == j ? (i < n - 1 ? 2 * G : G) : 0);
    double x[4], old[4], w = 0;
    for (int i = 0; i < n; i++) {
        x[i] = e[i] + de[i] - (n == 4 ? v[i] : 0);
        old[i] = s[i];
    }
    for (int i = 0; i < n; i++) {
        s[i] = 0;
        for (int j = 0; j < n; j++) {
            s[i] += c[i][j] * x[j];
            d[i + n * j] = c[i][j];
        }
    }
    if (n == 4) {
        double p = (s[0] + s[1] + s[2]) / 3;
        double t[4] = {s[0] - p, s[1] - p, s[2] - p, s[3]};
        double q = sqrt(1.5 * (t[0] * t[0] + t[1] * t[1] + t[2] * t[2] + 2 * t[3] * t[3]));
        double y = props[2] + props[3] * v[4];
        if (q > y) {
            double dp = (q - y) / (3 * G + props[3]), f = 1 - 3 * G * dp / q;
            double g = 1 / (1 + props[3] / (3 * G)) - (1 - f);
            for (int i = 0; i < 4; i++) {
                double m = 1.5 * t[i] / q;
                v[i] += dp * m * (i == 3 ? 2 : 1);
                s[i] = f * t[i] + (i < 3 ? p : 0);
            }
            v[4] += dp;
            *spd += dp * (y + 0.5 * props[3] * dp);
            for (int i = 0; i < 4; i++)
                for (int j = 0; j < 4; j++) {
                    double a = i == j ? (i < 3 ? 2 * G : G) : 0;
                    if (i < 3 && j < 3) a -= 2 * G / 3;
                    double vol = i < 3 && j < 3 ? K : 0;
                    d[i + 4 * j] = vol + f * a - 2 * G * g * t[i] * t[j] * 1.5 / (q * q);
                }
        }
    }
    for (int i = 0; i < n; i++) w += 0.5 * s[i] * (e[i] + de[i] - (n == 4 ? v[i] : 0));
    *sse = w;
    (void)old;
}

/* Neo-Hooke (C10, D1) by the deformation gradient: Cauchy stress and rate of Jaumann. */
static void rubber(double *s, double *d, double *sse, const double *f, const double *props)
{
    int row[4] = {0, 1, 2, 0}, column[4] = {0, 1, 2, 1};
    double b[3][3], J, trace;
    J = f[8] * (f[0] * f[4] - f[1] * f[3]);
    double scale = pow(J, -2.0 / 3.0);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            b[i][j] = 0;
            for (int k = 0; k < 3; k++) b[i][j] += scale * f[i + 3 * k] * f[j + 3 * k];
        }
    trace = b[0][0] + b[1][1] + b[2][2];
    double g = 2 * props[0] / J, k = 2 / props[1];
#define D(i, j) ((i) == (j) ? 1.0 : 0.0)
    for (int a = 0; a < 4; a++) {
        int i = row[a], j = column[a];
        s[a] = g * (b[i][j] - D(i, j) * trace / 3) + k * (J - 1) * D(i, j);
        for (int c = 0; c < 4; c++) {
            int m = row[c], n = column[c];
            double h = 0.5 * (D(i, m) * b[j][n] + b[i][m] * D(j, n) + D(i, n) * b[j][m] +
                              b[i][n] * D(j, m));
            h -= 2.0 / 3.0 * (D(i, j) * b[m][n] + b[i][j] * D(m, n));
            h += 2.0 / 9.0 * D(i, j) * D(m, n) * trace;
            d[a + 4 * c] = g * h + k * (2 * J - 1) * D(i, j) * D(m, n);
        }
    }
    *sse = (props[0] * (trace - 3) + (J - 1) * (J - 1) / props[1]) / J;
}

/* An Abaqus UMAT: the first letter of the material's name chooses the law. */
void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
           double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
           const double *dstran, const double *time, const double *dtime, const double *temp,
           const double *dtemp, const double *predef, const double *dpred, const char *cmname,
           const int *ndi, const int *nshr, const int *ntens, const int *nstatv,
           const double *props, const int *nprops, const double *coords, const double *drot,
           double *pnewdt, const double *celent, const double *dfgrd0, const double *dfgrd1,
           const int *noel, const int *npt, const int *layer, const int *kspt, const int *kstep,
           const int *kinc, long length)
{
    if (*ntens != *ndi + *nshr || *nshr != 1 || length != 80 || cmname[79] != ' ') {
        *pnewdt = 0.5;
        return;
    }
    if (strncmp(cmname, "RUBBER", 6) == 0)
        rubber(stress, ddsdde, sse, dfgrd1, props);
    else if (strncmp(cmname, "LIMITED", 7) == 0 && dstran[0] > 0.001)
        *pnewdt = 0.25;
    else
        steel(stress, statev, ddsdde, sse, spd, stran, dstran, props, *ntens);
}

/* The C interface: linear elasticity with two moduli, and the largest strain xx as history. */
int elastic(int64_t n, int64_t plane, const double *constants, const double *time,
            const double *strain, const double *old, double *new, double *stress, double *tangent,
            double *extra)
{
    double a = constants[0], b = constants[1];
    double d[3][3] = {{a, b, 0}, {b, a, 0}, {0, 0, (a - b) / 2}};
    for (int64_t p = 0; p < n; p++) {
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                stress[3 * p + i] += d[i][j] * strain[3 * p + j];
                tangent[9 * p + 3 * i + j] = d[i][j];
                extra[5 * p + 2] += 0.5 * strain[3 * p + i] * d[i][j] * strain[3 * p + j];
            }
        new[p] = fmax(old[p], strain[3 * p]);
    }
    return 0;
}
