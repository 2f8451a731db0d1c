// OpenXR API layer for tests on runtimes without a headset, such as Monado with a simulated one. Applications need no change.
//
// PLAYER_CSV: an eye tracker plays this scanpath through XR_EXT_eye_gaze_interaction.
// PLAYER_EVENTS: what happens after how many xrWaitFrame, as "60:recentre,90:off,110:on,120:blind,140:see,150:lose": the
// world's origin changes; the headset is taken off (nothing is to be rendered) and put on; the tracker loses the eyes and
// finds them; the session is lost; "size": the runtime recommends other views; "gone": the runtime ends. PLAYER_LOOP: after
// so many xrWaitFrame, they happen again. PLAYER_SIZES=A,B: the recommended side in pixels, before and after "size".
// It says once that it was given depth, and in what range.
//
// One instance and one session at a time, one gaze action.
#include <openxr/openxr.h>
#include <openxr/openxr_loader_negotiation.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static PFN_xrGetInstanceProcAddr next_proc;
static PFN_xrGetSystemProperties next_properties;
static PFN_xrSuggestInteractionProfileBindings next_suggest;
static PFN_xrCreateActionSpace next_action_space;
static PFN_xrLocateSpace next_locate;
static PFN_xrGetActionStatePose next_pose;
static PFN_xrPathToString path_to_string;
static PFN_xrCreateReferenceSpace reference_space;
static PFN_xrWaitFrame next_wait;
static PFN_xrPollEvent next_poll;
static PFN_xrCreateSession next_session;
static PFN_xrEnumerateViewConfigurationViews next_views;
static PFN_xrEndFrame next_end;
static XrInstance instance;
static XrSession session;
static int is_off, is_blind, is_resized, has_said_depth;
static long frames;
static XrTime last_time;
static XrEventDataBuffer queued[16];
static int queue_first, queue_end;
static XrAction gaze_action;
static XrSpace gaze_space, view_space;
static XrTime start;

static struct { double t; float x, y; int valid; } *samples;
static size_t count;
static float px[2], cm[2], distance_cm;

static void read_scanpath(void) {
    const char *path = getenv("PLAYER_CSV");
    FILE *file = path ? fopen(path, "r") : NULL;
    char line[256];
    double t; float x, y; int valid;
    if (!file) return;
    while (fgets(line, sizeof line, file)) {
        sscanf(line, "# screen_px: %fx%f", &px[0], &px[1]);
        sscanf(line, "# screen_cm: %fx%f", &cm[0], &cm[1]);
        sscanf(line, "# distance_cm: %f", &distance_cm);
        if (sscanf(line, "%lf,%f,%f,%d", &t, &x, &y, &valid) == 4) {
            samples = realloc(samples, (count + 1) * sizeof *samples);
            samples[count].t = t; samples[count].x = x; samples[count].y = y; samples[count++].valid = valid;
        }
    }
    fclose(file);
    fprintf(stderr, "player: %zu samples\n", count);
}

static XrResult get_properties(XrInstance i, XrSystemId system, XrSystemProperties *properties) {
    XrResult result = next_properties(i, system, properties);
    for (XrBaseOutStructure *s = (XrBaseOutStructure *)properties->next; s && XR_SUCCEEDED(result); s = s->next)
        if (s->type == XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT)
            ((XrSystemEyeGazeInteractionPropertiesEXT *)s)->supportsEyeGazeInteraction = count > 0;
    return result;
}

static XrResult suggest(XrInstance i, const XrInteractionProfileSuggestedBinding *bindings) {
    for (uint32_t k = 0; k < bindings->countSuggestedBindings; k++) {
        char name[XR_MAX_PATH_LENGTH]; uint32_t length;
        const XrActionSuggestedBinding *binding = &bindings->suggestedBindings[k];
        if (XR_SUCCEEDED(path_to_string(i, binding->binding, sizeof name, &length, name))
            && !strcmp(name, "/user/eyes_ext/input/gaze_ext/pose")) gaze_action = binding->action;
    }
    return next_suggest(i, bindings);
}

static XrResult action_space(XrSession session, const XrActionSpaceCreateInfo *info, XrSpace *space) {
    XrResult result = next_action_space(session, info, space);
    if (XR_SUCCEEDED(result) && info->action == gaze_action) {
        XrReferenceSpaceCreateInfo view = {XR_TYPE_REFERENCE_SPACE_CREATE_INFO, NULL, XR_REFERENCE_SPACE_TYPE_VIEW, {{0, 0, 0, 1}, {0, 0, 0}}};
        gaze_space = *space;
        reference_space(session, &view, &view_space);
    }
    return result;
}

static XrResult pose_state(XrSession session, const XrActionStateGetInfo *info, XrActionStatePose *state) {
    XrResult result = next_pose(session, info, state);
    if (XR_SUCCEEDED(result) && info->action == gaze_action) state->isActive = XR_TRUE;
    return result;
}

static XrQuaternionf product(XrQuaternionf a, XrQuaternionf b) {
    XrQuaternionf q = {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
                       a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    return q;
}

static XrResult locate(XrSpace space, XrSpace base, XrTime time, XrSpaceLocation *location) {
    if (space != gaze_space || space == XR_NULL_HANDLE || !count) return next_locate(space, base, time, location);
    XrResult result = next_locate(view_space, base, time, location);
    if (XR_FAILED(result)) return result;
    if (!start) start = time;
    double t = fmod((time - start) / 1e9, samples[count - 1].t);
    size_t k = 0;
    while (k + 1 < count && samples[k + 1].t <= t) k++;
    for (XrBaseOutStructure *s = (XrBaseOutStructure *)location->next; s; s = s->next)
        if (s->type == XR_TYPE_EYE_GAZE_SAMPLE_TIME_EXT) ((XrEyeGazeSampleTimeEXT *)s)->time = time;
    if (!samples[k].valid || is_blind) {
        location->locationFlags &= ~(XrSpaceLocationFlags)(XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT);
        return result;
    }
    // The shortest rotation from -z to the direction.
    float x = (samples[k].x / px[0] - 0.5f) * cm[0], y = (0.5f - samples[k].y / px[1]) * cm[1], z = -distance_cm;
    float length = sqrtf(x * x + y * y + z * z);
    XrQuaternionf turn = {y / length, -x / length, 0, 1 - z / length};
    float norm = sqrtf(turn.x * turn.x + turn.y * turn.y + turn.w * turn.w);
    turn.x /= norm; turn.y /= norm; turn.w /= norm;
    location->pose.orientation = product(location->pose.orientation, turn);
    location->locationFlags |= XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT | XR_SPACE_LOCATION_POSITION_TRACKED_BIT;
    return result;
}

static void put(const void *event, size_t size) {
    if (queue_end - queue_first < 16) memcpy(&queued[queue_end++ % 16], event, size);
}

static void put_state(XrSessionState state) {
    XrEventDataSessionStateChanged event = {XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED, NULL, session, state, last_time};
    put(&event, sizeof event);
}

static void happen(const char *what) {
    fprintf(stderr, "player: %s after %ld frames\n", what, frames);
    if (!strcmp(what, "recentre")) {
        XrEventDataReferenceSpaceChangePending event = {XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING, NULL, session,
            XR_REFERENCE_SPACE_TYPE_LOCAL, last_time + 1, XR_FALSE, {{0, 0, 0, 1}, {0, 0, 0}}};
        put(&event, sizeof event);
    } else if (!strcmp(what, "off")) {
        is_off = 1; put_state(XR_SESSION_STATE_VISIBLE); put_state(XR_SESSION_STATE_SYNCHRONIZED);
    } else if (!strcmp(what, "on")) {
        is_off = 0; put_state(XR_SESSION_STATE_VISIBLE); put_state(XR_SESSION_STATE_FOCUSED);
    } else if (!strcmp(what, "blind")) is_blind = 1;
    else if (!strcmp(what, "see")) is_blind = 0;
    else if (!strcmp(what, "lose")) put_state(XR_SESSION_STATE_LOSS_PENDING);
    else if (!strcmp(what, "size")) is_resized = 1;
    else if (!strcmp(what, "gone")) {
        XrEventDataInstanceLossPending event = {XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING, NULL, last_time};
        put(&event, sizeof event);
    }
    else { fprintf(stderr, "player: unknown event %s\n", what); abort(); }
}

static XrResult wait_frame(XrSession s, const XrFrameWaitInfo *info, XrFrameState *state) {
    XrResult result = next_wait(s, info, state);
    if (XR_FAILED(result)) return result;
    last_time = state->predictedDisplayTime;
    const char *loop = getenv("PLAYER_LOOP");
    long now = ++frames;
    if (loop && atol(loop) > 0) now %= atol(loop);
    char what[32]; long at; int used;
    for (const char *rest = getenv("PLAYER_EVENTS"); rest && sscanf(rest, "%ld:%31[^,]%n", &at, what, &used) == 2;) {
        if (at == now) happen(what);
        rest += used;
        if (*rest++ != ',') break;
    }
    if (is_off) state->shouldRender = XR_FALSE;
    return result;
}

static XrResult poll_event(XrInstance i, XrEventDataBuffer *buffer) {
    if (queue_first == queue_end) return next_poll(i, buffer);
    *buffer = queued[queue_first++ % 16];
    return XR_SUCCESS;
}

static XrResult create_session(XrInstance i, const XrSessionCreateInfo *info, XrSession *out) {
    XrResult result = next_session(i, info, out);
    if (XR_SUCCEEDED(result)) { session = *out; gaze_space = view_space = XR_NULL_HANDLE; }
    return result;
}

static XrResult views(XrInstance i, XrSystemId system, XrViewConfigurationType type, uint32_t capacity, uint32_t *found, XrViewConfigurationView *out) {
    XrResult result = next_views(i, system, type, capacity, found, out);
    int sides[2];
    const char *text = getenv("PLAYER_SIZES");
    if (XR_FAILED(result) || !text || sscanf(text, "%d,%d", &sides[0], &sides[1]) != 2) return result;
    for (uint32_t k = 0; k < capacity; k++) out[k].recommendedImageRectWidth = out[k].recommendedImageRectHeight = sides[is_resized];
    return result;
}

static XrResult end_frame(XrSession s, const XrFrameEndInfo *info) {
    for (uint32_t k = 0; k < info->layerCount && !has_said_depth; k++) {
        if (info->layers[k]->type != XR_TYPE_COMPOSITION_LAYER_PROJECTION) continue;
        const XrCompositionLayerProjectionView *eyes = ((const XrCompositionLayerProjection *)info->layers[k])->views;
        const XrCompositionLayerDepthInfoKHR *depth[2] = {eyes[0].next, eyes[1].next};
        if (!depth[0] || !depth[1] || depth[0]->type != XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR) continue;
        has_said_depth = 1;
        fprintf(stderr, "player: depth of layers %d and %d, %g to %g is %g to %g m\n", depth[0]->subImage.imageArrayIndex,
            depth[1]->subImage.imageArrayIndex, depth[0]->minDepth, depth[0]->maxDepth, depth[0]->nearZ, depth[0]->farZ);
    }
    return next_end(s, info);
}

static XrResult proc(XrInstance i, const char *name, PFN_xrVoidFunction *function) {
    static const struct { const char *name; PFN_xrVoidFunction function; } mine[] = {
        {"xrGetSystemProperties", (PFN_xrVoidFunction)get_properties},
        {"xrSuggestInteractionProfileBindings", (PFN_xrVoidFunction)suggest},
        {"xrCreateActionSpace", (PFN_xrVoidFunction)action_space},
        {"xrGetActionStatePose", (PFN_xrVoidFunction)pose_state},
        {"xrLocateSpace", (PFN_xrVoidFunction)locate},
        {"xrWaitFrame", (PFN_xrVoidFunction)wait_frame},
        {"xrPollEvent", (PFN_xrVoidFunction)poll_event},
        {"xrCreateSession", (PFN_xrVoidFunction)create_session},
        {"xrEnumerateViewConfigurationViews", (PFN_xrVoidFunction)views},
        {"xrEndFrame", (PFN_xrVoidFunction)end_frame},
    };
    for (size_t k = 0; k < sizeof mine / sizeof *mine; k++)
        if (!strcmp(name, mine[k].name)) { *function = mine[k].function; return XR_SUCCESS; }
    return next_proc(i, name, function);
}

static XrResult create(const XrInstanceCreateInfo *info, const XrApiLayerCreateInfo *layer, XrInstance *out) {
    XrApiLayerCreateInfo below = *layer;
    below.nextInfo = layer->nextInfo->next;
    XrResult result = layer->nextInfo->nextCreateApiLayerInstance(info, &below, out);
    if (XR_FAILED(result)) return result;
    instance = *out;
    next_proc = layer->nextInfo->nextGetInstanceProcAddr;
#define GET(name, target) next_proc(instance, name, (PFN_xrVoidFunction *)&target)
    GET("xrGetSystemProperties", next_properties);
    GET("xrSuggestInteractionProfileBindings", next_suggest);
    GET("xrCreateActionSpace", next_action_space);
    GET("xrGetActionStatePose", next_pose);
    GET("xrLocateSpace", next_locate);
    GET("xrWaitFrame", next_wait);
    GET("xrPollEvent", next_poll);
    GET("xrCreateSession", next_session);
    GET("xrEnumerateViewConfigurationViews", next_views);
    GET("xrEndFrame", next_end);
    queue_first = queue_end = 0;
    GET("xrPathToString", path_to_string);
    GET("xrCreateReferenceSpace", reference_space);
    if (!count) read_scanpath();
    return result;
}

XrResult xrNegotiateLoaderApiLayerInterface(const XrNegotiateLoaderInfo *loader, const char *name, XrNegotiateApiLayerRequest *request) {
    (void)loader; (void)name;
    request->layerInterfaceVersion = XR_CURRENT_LOADER_API_LAYER_VERSION;
    request->layerApiVersion = XR_CURRENT_API_VERSION;
    request->getInstanceProcAddr = proc;
    request->createApiLayerInstance = create;
    return XR_SUCCESS;
}
