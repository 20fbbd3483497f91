// Stand-in for the CUDA driver: host memory, and kernels from the library built by compiler.c. Rejects out-of-bounds copies
// and oversized blocks. STAND_IN_LAUNCHES: launches before failure; STAND_IN_MEMORY: bytes.

#include <dlfcn.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef int result;
typedef uint64_t address;
enum { SUCCESS = 0, INVALID_VALUE = 1, OUT_OF_MEMORY = 2, INVALID_DEVICE = 101, INVALID_IMAGE = 200, NOT_FOUND = 500, LAUNCH_FAILED = 719 };

static int context;
static unsigned long launches;
static size_t used;

static size_t setting(const char *name, size_t otherwise) {
    const char *text = getenv(name);
    return text ? strtoull(text, NULL, 10) : otherwise;
}

result cuInit(unsigned flags) { return SUCCESS; }
result cuDriverGetVersion(int *version) { return *version = 13000, SUCCESS; }
result cuDeviceGet(int *device, int number) { return *device = 0, number == 0 ? SUCCESS : INVALID_DEVICE; }
result cuDeviceGetCount(int *count) { return *count = 1, SUCCESS; }
result cuDeviceGetName(char *name, int length, int device) { return snprintf(name, length, "stand-in"), SUCCESS; }
// 75, 76: compute capability 9.0; other features exist.
result cuDeviceGetAttribute(int *value, int which, int device) { return *value = which == 75 ? 9 : which == 76 ? 0 : 1, SUCCESS; }
result cuDevicePrimaryCtxRetain(void **out, int device) { return *out = &context, SUCCESS; }
result cuDevicePrimaryCtxRelease_v2(int device) { return SUCCESS; }
result cuCtxSetCurrent(void *of) { return SUCCESS; }
result cuCtxGetCurrent(void **out) { return *out = &context, SUCCESS; }
result cuCtxSynchronize(void) { return SUCCESS; }

// The "code" is a library name.
result cuModuleLoadData(void **module, const void *code) { return (*module = dlopen(code, RTLD_NOW)) ? SUCCESS : INVALID_IMAGE; }
result cuModuleUnload(void *module) { return SUCCESS; }
result cuModuleGetFunction(void **function, void *module, const char *name) {
    return (*function = dlsym(module, name)) ? SUCCESS : NOT_FOUND;
}

// Header of an allocation: size and previous allocation.
enum { HEAD = 64 };
struct allocation { size_t bytes; struct allocation *next, **self; };
static struct allocation *all;
static struct allocation *head_of(address of) { return (struct allocation *)(of - HEAD); }
/// Whether a range lies in one allocation.
static int inside(address from, size_t bytes) {
    for (struct allocation *one = all; one; one = one->next) {
        const address base = (address)one + HEAD;
        if (from >= base && from - base <= one->bytes) return bytes <= one->bytes - (from - base);
    }
    return 0;
}
result cuMemAllocAsync(address *out, size_t bytes, void *stream) {
    if (used + bytes > setting("STAND_IN_MEMORY", (size_t)1 << 40)) return OUT_OF_MEMORY;
    struct allocation *one = malloc(bytes + HEAD);
    if (!one) return OUT_OF_MEMORY;
    used += bytes;
    *out = (address)one + HEAD;
    one->bytes = bytes;
    one->next = all;
    one->self = &all;
    if (all) all->self = &one->next;
    all = one;
    return SUCCESS;
}
result cuMemFreeAsync(address of, void *stream) {
    struct allocation *one = head_of(of);
    used -= one->bytes;
    *one->self = one->next;
    if (one->next) one->next->self = one->self;
    free(one);
    return SUCCESS;
}
result cuMemsetD8Async(address to, unsigned char value, size_t bytes, void *stream) {
    // Unlike zeros, this reveals reads of uninitialised memory.
    if (!inside(to, bytes)) return INVALID_VALUE;
    return memset((void *)to, 0xff, bytes), SUCCESS;
}
result cuMemcpyHtoDAsync_v2(address to, const void *from, size_t bytes, void *stream) {
    if (!inside(to, bytes)) return INVALID_VALUE;
    return memcpy((void *)to, from, bytes), SUCCESS;
}
result cuMemcpyDtoHAsync_v2(void *to, address from, size_t bytes, void *stream) {
    if (!inside(from, bytes)) return INVALID_VALUE;
    return memcpy(to, (void *)from, bytes), SUCCESS;
}
result cuMemHostAlloc(void **out, size_t bytes, unsigned flags) { return (*out = malloc(bytes)) ? SUCCESS : OUT_OF_MEMORY; }
result cuMemFreeHost(void *of) { return free(of), SUCCESS; }

result cuStreamSynchronize(void *stream) { return SUCCESS; }
result cuStreamWaitEvent(void *stream, void *event, unsigned flags) { return SUCCESS; }
result cuEventCreate(void **out, unsigned flags) { return *out = &context, SUCCESS; }
result cuEventRecord(void *event, void *stream) { return SUCCESS; }
result cuEventSynchronize(void *event) { return SUCCESS; }
result cuEventDestroy_v2(void *event) { return SUCCESS; }

result cuLaunchKernel(void *function, unsigned grid_x, unsigned grid_y, unsigned grid_z, unsigned block_x, unsigned block_y, unsigned block_z,
                      unsigned shared, void *stream, void **arguments, void **extra) {
    if (++launches > setting("STAND_IN_LAUNCHES", (size_t)1 << 60)) return LAUNCH_FAILED;
    if (grid_y * grid_z * block_y * block_z != 1 || block_x > 128 || shared != 0 || !arguments) return INVALID_VALUE;
    // All threads, in alternating order.
    ((void (*)(const void *, unsigned, int))function)(arguments[0], grid_x * block_x, launches % 4 > 1);
    return SUCCESS;
}

static const char *name_of(result error) {
    return error == OUT_OF_MEMORY ? "CUDA_ERROR_OUT_OF_MEMORY" : error == LAUNCH_FAILED ? "CUDA_ERROR_LAUNCH_FAILED" : "an error";
}
result cuGetErrorName(result error, const char **name) { return *name = name_of(error), SUCCESS; }
result cuGetErrorString(result error, const char **text) { return *text = name_of(error), SUCCESS; }
