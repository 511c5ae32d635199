/* What miniaudio asks of ALSA, on the pipes of tests/ros/sound/sound_card.py alone.

   For machines without the library: the names are read from the same configuration, and a device
   that has not moved a whole block does not return, as with the real one. What miniaudio looks up
   and does not find here, it does not call for these devices. */

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define MOST 8
#define SAMPLE 2

/* As in pcm.h of alsa-lib. */
enum { PLAYBACK = 0, CAPTURE = 1, FORMAT_S16_LE = 2, STATE_RUNNING = 3 };

typedef struct { char name[64], said[4096], played[4096]; } Device;
typedef struct { int pipe, reads; } Pcm;

static Device devices[MOST];
static void *hints[MOST + 1];
static unsigned int channels = 1, rate = 16000, periods = 3;
static unsigned long buffer = 4800;

static void path_after(const char *line, const char *word, char *path) {
    const char *found = strstr(line, word) + strlen(word);
    snprintf(path, sizeof devices[0].said, "%s", found + strspn(found, " "));
    path[strcspn(path, "\n")] = 0;
}

static int read_configuration(void) {
    const char *where = getenv("ALSA_CONFIG_PATH");
    FILE *file = where ? fopen(where, "r") : NULL;
    char line[4096];
    int count = 0;
    memset(devices, 0, sizeof devices);
    while (file && fgets(line, sizeof line, file)) {
        char name[64];
        if (sscanf(line, "pcm.%63[a-z] {", name) == 1 && count < MOST)
            strcpy(devices[count++].name, name);
        else if (count && strstr(line, "infile "))
            path_after(line, "infile ", devices[count - 1].said);
        else if (count && strstr(line, " file /"))
            path_after(line, " file ", devices[count - 1].played);
    }
    if (file) fclose(file);
    return count;
}

int snd_device_name_hint(int card, const char *interface, void ***made) {
    int count = read_configuration();
    (void)card; (void)interface;
    for (int at = 0; at < count; at++) hints[at] = &devices[at];
    hints[count] = NULL;
    *made = hints;
    return 0;
}
char *snd_device_name_get_hint(const void *hint, const char *id) {
    return strcmp(id, "IOID") ? strdup(((const Device *)hint)->name) : NULL;
}
int snd_device_name_free_hint(void **given) { (void)given; return 0; }
int snd_card_get_index(const char *name) { (void)name; return -ENODEV; }
int snd_config_update_free_global(void) { return 0; }

int snd_pcm_open(Pcm **made, const char *name, int stream, int mode) {
    int count = read_configuration();
    (void)mode;
    for (int at = 0; at < count; at++) {
        const char *path = stream == CAPTURE ? devices[at].said : devices[at].played;
        if (strcmp(devices[at].name, name) || !*path) continue;
        Pcm *one = malloc(sizeof *one);
        if (!one) return -ENOMEM;
        one->reads = stream == CAPTURE;
        one->pipe = open(path, (one->reads ? O_RDONLY : O_WRONLY) | O_CLOEXEC);
        *made = one;
        return one->pipe < 0 ? -errno : 0;
    }
    return -ENOENT;
}
int snd_pcm_close(Pcm *one) {
    int result = close(one->pipe);
    free(one);
    return result;
}

static long moved(Pcm *one, char *block, unsigned long frames) {
    size_t want = frames * SAMPLE, done = 0;
    while (done < want) {
        ssize_t step = one->reads ? read(one->pipe, block + done, want - done)
                                  : write(one->pipe, block + done, want - done);
        if (step <= 0) return -ENODEV;
        done += (size_t)step;
    }
    return (long)frames;
}
long snd_pcm_readi(Pcm *one, void *block, unsigned long frames) { return moved(one, block, frames); }
long snd_pcm_writei(Pcm *one, const void *block, unsigned long frames) {
    return moved(one, (char *)block, frames);
}
int snd_pcm_poll_descriptors_count(Pcm *one) { (void)one; return 1; }
int snd_pcm_poll_descriptors(Pcm *one, struct pollfd *made, unsigned int space) {
    (void)space;
    *made = (struct pollfd){.fd = one->pipe, .events = one->reads ? POLLIN : POLLOUT};
    return 1;
}
int snd_pcm_poll_descriptors_revents(Pcm *one, struct pollfd *polled, unsigned int count,
                                     unsigned short *events) {
    (void)one; (void)count;
    *events = (unsigned short)polled->revents;
    return 0;
}
int snd_pcm_state(Pcm *one) { (void)one; return STATE_RUNNING; }
int snd_pcm_start(Pcm *one) { (void)one; return 0; }
int snd_pcm_drop(Pcm *one) { (void)one; return 0; }
int snd_pcm_drain(Pcm *one) { (void)one; return 0; }
int snd_pcm_prepare(Pcm *one) { (void)one; return 0; }
int snd_pcm_recover(Pcm *one, int error, int silent) { (void)one; (void)silent; return error; }
int snd_pcm_nonblock(Pcm *one, int wanted) { (void)one; (void)wanted; return 0; }
void *snd_pcm_get_chmap(Pcm *one) { (void)one; return NULL; }

size_t snd_pcm_info_sizeof(void) { return 64; }
int snd_pcm_info(Pcm *one, void *to) { (void)one; (void)to; return 0; }
const char *snd_pcm_info_get_name(const void *of) { (void)of; return "pipe"; }

size_t snd_pcm_hw_params_sizeof(void) { return 64; }
int snd_pcm_hw_params_any(Pcm *one, void *to) { (void)one; (void)to; return 0; }
int snd_pcm_hw_params(Pcm *one, void *to) { (void)one; (void)to; return 0; }
int snd_pcm_hw_params_set_access(Pcm *one, void *to, int access) {
    (void)one; (void)to; (void)access;
    return 0;
}
int snd_pcm_hw_params_test_format(Pcm *one, void *to, int format) {
    (void)one; (void)to;
    return format == FORMAT_S16_LE ? 0 : -EINVAL;
}
int snd_pcm_hw_params_set_format(Pcm *one, void *to, int format) {
    return snd_pcm_hw_params_test_format(one, to, format);
}
int snd_pcm_hw_params_test_channels(Pcm *one, void *to, unsigned int wanted) {
    (void)one; (void)to;
    return wanted == 1 ? 0 : -EINVAL;
}
int snd_pcm_hw_params_test_rate(Pcm *one, void *to, unsigned int wanted, int way) {
    (void)one; (void)to; (void)way;
    return wanted == 16000 ? 0 : -EINVAL;
}
int snd_pcm_hw_params_get_channels_min(const void *of, unsigned int *got) {
    (void)of;
    *got = 1;
    return 0;
}
int snd_pcm_hw_params_get_channels_max(const void *of, unsigned int *got) {
    return snd_pcm_hw_params_get_channels_min(of, got);
}
int snd_pcm_hw_params_get_rate_min(const void *of, unsigned int *got, int *way) {
    (void)of; (void)way;
    *got = 16000;
    return 0;
}
int snd_pcm_hw_params_get_rate_max(const void *of, unsigned int *got, int *way) {
    return snd_pcm_hw_params_get_rate_min(of, got, way);
}
int snd_pcm_hw_params_set_rate_resample(Pcm *one, void *to, unsigned int wanted) {
    (void)one; (void)to; (void)wanted;
    return 0;
}
int snd_pcm_hw_params_set_channels_near(Pcm *one, void *to, unsigned int *wanted) {
    (void)one; (void)to;
    channels = *wanted;
    return 0;
}
int snd_pcm_hw_params_set_rate_near(Pcm *one, void *to, unsigned int *wanted, int *way) {
    (void)one; (void)to; (void)way;
    rate = *wanted;
    return 0;
}
int snd_pcm_hw_params_set_channels(Pcm *one, void *to, unsigned int wanted) {
    return snd_pcm_hw_params_set_channels_near(one, to, &wanted);
}
int snd_pcm_hw_params_set_rate(Pcm *one, void *to, unsigned int wanted, int way) {
    return snd_pcm_hw_params_set_rate_near(one, to, &wanted, &way);
}
int snd_pcm_hw_params_set_buffer_size_near(Pcm *one, void *to, unsigned long *wanted) {
    (void)one; (void)to;
    buffer = *wanted;
    return 0;
}
int snd_pcm_hw_params_set_periods_near(Pcm *one, void *to, unsigned int *wanted, int *way) {
    (void)one; (void)to; (void)way;
    periods = *wanted;
    return 0;
}
int snd_pcm_hw_params_get_format(const void *of, int *got) { (void)of; *got = FORMAT_S16_LE; return 0; }
int snd_pcm_hw_params_get_channels(const void *of, unsigned int *got) {
    (void)of;
    *got = channels;
    return 0;
}
int snd_pcm_hw_params_get_rate(const void *of, unsigned int *got, int *way) {
    (void)of; (void)way;
    *got = rate;
    return 0;
}
int snd_pcm_hw_params_get_buffer_size(const void *of, unsigned long *got) {
    (void)of;
    *got = buffer;
    return 0;
}
int snd_pcm_hw_params_get_periods(const void *of, unsigned int *got, int *way) {
    (void)of; (void)way;
    *got = periods;
    return 0;
}

size_t snd_pcm_sw_params_sizeof(void) { return 64; }
int snd_pcm_sw_params_current(Pcm *one, void *to) { (void)one; (void)to; return 0; }
int snd_pcm_sw_params(Pcm *one, void *to) { (void)one; (void)to; return 0; }
int snd_pcm_sw_params_get_boundary(const void *of, unsigned long *got) {
    (void)of;
    *got = 1UL << 30;
    return 0;
}
int snd_pcm_sw_params_set_avail_min(Pcm *one, void *to, unsigned long frames) {
    (void)one; (void)to; (void)frames;
    return 0;
}
int snd_pcm_sw_params_set_start_threshold(Pcm *one, void *to, unsigned long frames) {
    (void)one; (void)to; (void)frames;
    return 0;
}
int snd_pcm_sw_params_set_stop_threshold(Pcm *one, void *to, unsigned long frames) {
    (void)one; (void)to; (void)frames;
    return 0;
}
