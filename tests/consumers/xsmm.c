/* What PyFR's OpenMP back end asks of libxsmm, in plain C: products C = alpha A B + beta C with a constant matrix A. Debian's libxsmm is
 * older than the one that PyFR 3.1 calls; this stands in for it so that PyFR runs, not so that it runs fast. Doubles only. */
#include <stdlib.h>
#include <string.h>

typedef struct {
    int rows, columns, inner, ldb, ldc;
    double beta;
    double *a;
} product;

void libxsmm_init(void) {}
void libxsmm_finalize(void) {}
unsigned long long libxsmm_timer_tick(void) { return 0; }

void *libxsmm_fsspmdm_create(int type, int rows, int columns, int inner, int lda, int ldb, int ldc, const void *alpha, const void *beta,
                             const void *a, int streamed, void *timer) {
    (void)streamed, (void)timer;
    product *own = type == 0 ? malloc(sizeof *own) : NULL;
    if (!own)
        return NULL;
    *own = (product){rows, columns, inner, ldb, ldc, *(const double *)beta, malloc(sizeof(double) * (size_t)rows * inner)};
    for (int i = 0; i < rows; i++)
        for (int k = 0; k < inner; k++)
            own->a[i * inner + k] = *(const double *)alpha * ((const double *)a)[i * lda + k];
    return own;
}

void libxsmm_fsspmdm_execute(const void *handle, const double *b, double *c) {
    const product *own = handle;
    for (int i = 0; i < own->rows; i++) {
        double *row = c + (size_t)i * own->ldc;
        if (own->beta == 0)
            memset(row, 0, sizeof(double) * own->columns);
        for (int k = 0; k < own->inner; k++) {
            const double a = own->a[i * own->inner + k], *from = b + (size_t)k * own->ldb;
            for (int j = 0; a != 0 && j < own->columns; j++)
                row[j] += a * from[j];
        }
    }
}

void libxsmm_fsspmdm_destroy(void *handle) {
    free(((product *)handle)->a);
    free(handle);
}
