/* Preloaded into a process, it notes in the file WATCHED what the process and its children open for writing or make as a
 * folder, and which sockets to other machines they open: `write PATH` and `net WHAT` on a line each.
 *
 * Python's own hooks do not see what a library in C or C++ does.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <netdb.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#define NEXT(name) ((__typeof__(&name))dlsym(RTLD_NEXT, #name))
#define MODE(flags, mode) \
    if ((flags) & (O_CREAT | O_TMPFILE)) { \
        va_list rest; \
        va_start(rest, flags); \
        mode = va_arg(rest, mode_t); \
        va_end(rest); \
    }

static void note(const char *kind, const char *before, const char *what) {
    char line[8192];
    const char *file = getenv("WATCHED");
    if (!file || !what)
        return;
    int length = snprintf(line, sizeof line, "%s %s%s\n", kind, before, what);
    int out = NEXT(open)(file, O_WRONLY | O_APPEND | O_CREAT, 0600);
    if (out >= 0 && write(out, line, (size_t)length) >= 0)
        close(out);
}

/* Note a path, relative to an open folder or to the one in which the process stands. */
static void note_path(int folder, const char *path) {
    char link[64], full[4096] = "";
    ssize_t length = 0;
    if (path && path[0] != '/' && folder == AT_FDCWD) {
        if (getcwd(full, sizeof full - 1))
            length = (ssize_t)strlen(full);
    } else if (path && path[0] != '/') {
        snprintf(link, sizeof link, "/proc/self/fd/%d", folder);
        length = readlink(link, full, sizeof full - 2);
    }
    if (length > 0)
        strcpy(full + length, "/");
    note("write", full, path);
}

static void note_open(int folder, const char *path, int flags) {
    if (flags & (O_WRONLY | O_RDWR | O_CREAT))
        note_path(folder, path);
}

#define OPEN(name) \
    int name(const char *path, int flags, ...) { \
        mode_t mode = 0; \
        MODE(flags, mode) \
        note_open(AT_FDCWD, path, flags); \
        return NEXT(name)(path, flags, mode); \
    }
#define OPENAT(name) \
    int name(int folder, const char *path, int flags, ...) { \
        mode_t mode = 0; \
        MODE(flags, mode) \
        note_open(folder, path, flags); \
        return NEXT(name)(folder, path, flags, mode); \
    }
#define FOPEN(name) \
    FILE *name(const char *path, const char *mode) { \
        if (strpbrk(mode, "wa+")) \
            note_path(AT_FDCWD, path); \
        return NEXT(name)(path, mode); \
    }

OPEN(open)
OPEN(open64)
OPENAT(openat)
OPENAT(openat64)
FOPEN(fopen)
FOPEN(fopen64)

int mkdir(const char *path, mode_t mode) {
    note_path(AT_FDCWD, path);
    return NEXT(mkdir)(path, mode);
}

int mkdirat(int folder, const char *path, mode_t mode) {
    note_path(folder, path);
    return NEXT(mkdirat)(folder, path, mode);
}

static void note_address(const char *call, const struct sockaddr *to) {
    if (to && to->sa_family != AF_UNIX && to->sa_family != AF_UNSPEC && to->sa_family != AF_NETLINK)
        note("net", "", call);
}

int connect(int fd, const struct sockaddr *to, socklen_t size) {
    note_address("connect", to);
    return NEXT(connect)(fd, to, size);
}

ssize_t sendto(int fd, const void *bytes, size_t count, int flags, const struct sockaddr *to, socklen_t size) {
    note_address("sendto", to);
    return NEXT(sendto)(fd, bytes, count, flags, to, size);
}

ssize_t sendmsg(int fd, const struct msghdr *message, int flags) {
    note_address("sendmsg", message->msg_name);
    return NEXT(sendmsg)(fd, message, flags);
}

int getaddrinfo(const char *host, const char *service, const struct addrinfo *hints, struct addrinfo **found) {
    note("net", "", host ? host : "getaddrinfo");
    return NEXT(getaddrinfo)(host, service, hints, found);
}

struct hostent *gethostbyname(const char *host) {
    note("net", "", host);
    return NEXT(gethostbyname)(host);
}
