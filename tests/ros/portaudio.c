/* What sounddevice asks of PortAudio, on the pipes of tests/ros/sound_card.py alone.

   For machines without the library: the names are read from the same configuration of ALSA, and a
   device that has not moved a whole block calls nobody back, as with the real one. */

#include <fcntl.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#define MOST 8
#define SAMPLE 2

/* The layouts are those of portaudio.h, version 19. */
typedef struct { int version, type; const char *name; int devices, input, output; } HostApi;
typedef struct {
    int version; const char *name; int api, inputs, outputs;
    double low_in, low_out, high_in, high_out, rate;
} Device;
typedef struct { int device, channels; unsigned long format; double latency; void *more; } Parameters;
typedef struct { int version; double in, out, rate; } StreamInfo;
typedef struct { double adc, now, dac; } Times;
typedef int Callback(const void *, void *, unsigned long, const Times *, unsigned long, void *);
typedef struct {
    int pipe, reads; unsigned long frames; Callback *call; void *user; StreamInfo info;
    volatile int active; pthread_t thread;
} Stream;

enum { INVALID_DEVICE = -9996, DEVICE_UNAVAILABLE = -9985, INSUFFICIENT_MEMORY = -9992 };

static Device devices[MOST];
static char names[MOST][64], paths[MOST][4096];
static int count;
static HostApi api = {1, 8, "ALSA", 0, -1, -1};

static void path_after(const char *line, const char *word, char *path) {
    const char *found = strstr(line, word);
    snprintf(path, sizeof paths[0], "%s", found + strlen(word) + strspn(found + strlen(word), " "));
    path[strcspn(path, "\n")] = 0;
}

int Pa_Initialize(void) {
    const char *where = getenv("ALSA_CONFIG_PATH");
    FILE *file = where ? fopen(where, "r") : NULL;
    char line[4096];
    count = 0;
    while (file && fgets(line, sizeof line, file)) {
        char name[64], path[4096];
        if (sscanf(line, "pcm.%63[a-z] {", name) == 1 && count < MOST) {
            Device fresh = {.version = 2, .name = names[count], .rate = 16000};
            strcpy(names[count], name);
            devices[count++] = fresh;
        } else if (count && strstr(line, "infile ")) {
            path_after(line, "infile ", paths[count - 1]);
            devices[count - 1].inputs = 1;
            devices[count - 1].outputs = 0;
        } else if (count && strstr(line, " file ") && strchr(line, '/')) {
            path_after(line, " file ", path);
            if (strcmp(path, "/dev/null")) {
                strcpy(paths[count - 1], path);
                devices[count - 1].outputs = 1;
            }
        }
    }
    if (file) fclose(file);
    api.devices = count;
    return 0;
}

int Pa_Terminate(void) { return 0; }
int Pa_GetVersion(void) { return 0x130700; }
const char *Pa_GetVersionText(void) { return "PortAudio of the tests"; }
const char *Pa_GetErrorText(int error) { return error ? "it cannot be opened" : "Success"; }
int Pa_GetHostApiCount(void) { return 1; }
int Pa_GetDefaultHostApi(void) { return 0; }
int Pa_HostApiTypeIdToHostApiIndex(int type) { return type == api.type ? 0 : -9979; }
int Pa_HostApiDeviceIndexToDeviceIndex(int host, int at) { return host ? INVALID_DEVICE : at; }
const HostApi *Pa_GetHostApiInfo(int host) { return host ? NULL : &api; }
int Pa_GetDeviceCount(void) { return count; }
int Pa_GetDefaultInputDevice(void) { return -1; }
int Pa_GetDefaultOutputDevice(void) { return -1; }
const Device *Pa_GetDeviceInfo(int at) { return at >= 0 && at < count ? &devices[at] : NULL; }
int Pa_GetSampleSize(unsigned long format) { return format == 8 ? SAMPLE : -9994; }

int Pa_OpenStream(Stream **made, const Parameters *in, const Parameters *out, double rate,
                  unsigned long frames, unsigned long flags, Callback *call, void *user) {
    int at = in ? in->device : out->device;
    Stream *stream = calloc(1, sizeof *stream);
    (void)flags;
    if (!stream) return INSUFFICIENT_MEMORY;
    stream->pipe = open(paths[at], (in ? O_RDONLY : O_WRONLY) | O_CLOEXEC);
    if (stream->pipe < 0) { free(stream); return DEVICE_UNAVAILABLE; }
    stream->reads = in != NULL;
    stream->frames = frames;
    stream->call = call;
    stream->user = user;
    stream->info = (StreamInfo){1, 0, 0, rate};
    *made = stream;
    return 0;
}

static int move(Stream *stream, char *block) {
    size_t want = stream->frames * SAMPLE, done = 0;
    while (done < want) {
        ssize_t step = stream->reads ? read(stream->pipe, block + done, want - done)
                                     : write(stream->pipe, block + done, want - done);
        if (step <= 0) return 0;
        done += (size_t)step;
    }
    return 1;
}

static void *live(void *given) {
    Stream *stream = given;
    char *block = malloc(stream->frames * SAMPLE);
    Times times = {0, 0, 0};
    int going = block != NULL;
    while (going && stream->reads)
        going = move(stream, block)
                && !stream->call(block, NULL, stream->frames, &times, 0, stream->user);
    while (going)
        going = !stream->call(NULL, block, stream->frames, &times, 0, stream->user)
                && move(stream, block);
    free(block);
    stream->active = 0;
    return NULL;
}

int Pa_StartStream(Stream *stream) {
    stream->active = 1;
    return pthread_create(&stream->thread, NULL, live, stream) ? INSUFFICIENT_MEMORY : 0;
}

const StreamInfo *Pa_GetStreamInfo(Stream *stream) { return &stream->info; }
int Pa_IsStreamActive(Stream *stream) { return stream->active; }
int Pa_SetStreamFinishedCallback(Stream *stream, void *call) { (void)stream; (void)call; return 0; }
