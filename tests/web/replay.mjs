// Repeats what wgpu recorded of a device (`gpu::recording` in crates/testing), on this browser's WebGPU, and compares
// everything that is read back with what was read back then.

import { constantsOf, parseRon } from "./ron.mjs";

// Name and content of a variant.
function variant(value) {
    return typeof value === "string" ? [value, undefined] : Object.entries(value)[0];
}

const words = (flags) => String(Array.isArray(flags) ? flags[0] : flags).split("|").map((flag) => flag.trim());
const bits = (flags, values) => words(flags).reduce((sum, flag) => sum | (flag === "" ? 0 : (values[flag] ?? unknown(flag))), 0);
const id = (pointer) => pointer.PointerId?.[0] ?? pointer;

function unknown(what) {
    throw new Error(`not known here: ${what}`);
}

// The device, and the modules and pipelines that all recordings share: most are alike, and take long to compile.
export class Browser {
    #modules = new Map();
    #pipelines = new Map();
    #layouts = new Map();

    static async open() {
        const adapter = await navigator.gpu?.requestAdapter();
        if (!adapter) throw new Error("no WebGPU adapter");
        const requiredLimits = {};
        for (const name in adapter.limits) requiredLimits[name] = adapter.limits[name];
        const browser = new Browser();
        browser.device = await adapter.requestDevice({ requiredLimits });
        browser.adapter = `${adapter.info.vendor} ${adapter.info.architecture}`;
        return browser;
    }

    module(code) {
        return this.#shared(this.#modules, code, () => this.device.createShaderModule({ code }));
    }

    layout(entries) {
        const make = () => this.device.createBindGroupLayout({ entries });
        return this.#shared(this.#layouts, JSON.stringify(entries), make);
    }

    // Resolves to a pipeline: several compile at the same time. `groups`: entries of the layouts of the bind groups;
    // without, they follow from the shader.
    pipeline(code, entryPoint, constants, groups) {
        return this.#shared(this.#pipelines, JSON.stringify([code, entryPoint, constants, groups]), () => {
            const bindGroupLayouts = groups?.map((entries) => this.layout(entries));
            return this.device.createComputePipelineAsync({
                layout: groups ? this.device.createPipelineLayout({ bindGroupLayouts }) : "auto",
                compute: { module: this.module(code), entryPoint, constants },
            });
        });
    }

    get pipelineCount() {
        return this.#pipelines.size;
    }

    #shared(map, key, make) {
        if (!map.has(key)) map.set(key, make());
        return map.get(key);
    }
}

const BUFFER_USAGE = {
    MAP_READ: GPUBufferUsage.MAP_READ,
    MAP_WRITE: GPUBufferUsage.COPY_DST,
    COPY_SRC: GPUBufferUsage.COPY_SRC,
    COPY_DST: GPUBufferUsage.COPY_DST,
    INDEX: GPUBufferUsage.INDEX,
    VERTEX: GPUBufferUsage.VERTEX,
    UNIFORM: GPUBufferUsage.UNIFORM,
    STORAGE: GPUBufferUsage.STORAGE,
    INDIRECT: GPUBufferUsage.INDIRECT,
};

const TEXTURE_USAGE = {
    COPY_SRC: GPUTextureUsage.COPY_SRC,
    COPY_DST: GPUTextureUsage.COPY_DST,
    TEXTURE_BINDING: GPUTextureUsage.TEXTURE_BINDING,
    STORAGE_BINDING: GPUTextureUsage.STORAGE_BINDING,
    RENDER_ATTACHMENT: GPUTextureUsage.RENDER_ATTACHMENT,
};

const kebab = (name) => name.replace(/([a-z0-9])([A-Z])/g, "$1-$2").toLowerCase();

function layoutEntry({ binding, ty }) {
    const [kind, content] = variant(ty);
    const entry = { binding, visibility: GPUShaderStage.COMPUTE };
    switch (kind) {
        case "Buffer": {
            const [type, storage] = variant(content.ty);
            const isReadOnly = type === "Storage" && storage.read_only;
            entry.buffer = {
                type: type === "Uniform" ? "uniform" : isReadOnly ? "read-only-storage" : "storage",
                hasDynamicOffset: content.has_dynamic_offset,
                minBindingSize: content.min_binding_size ?? 0,
            };
            return entry;
        }
        case "Texture": {
            const [type, float] = variant(content.sample_type);
            const isFilterable = type === "Float" && float.filterable;
            entry.texture = {
                sampleType: type === "Float" && !isFilterable ? "unfilterable-float" : kebab(type),
                viewDimension: content.view_dimension,
                multisampled: content.multisampled,
            };
            return entry;
        }
        case "StorageTexture":
            entry.storageTexture = {
                access: kebab(content.access),
                format: content.format,
                viewDimension: content.view_dimension,
            };
            return entry;
        default:
            return unknown(`binding ${kind}`);
    }
}

const copied = ({ texture, mip_level, origin }, get) => ({ texture: get(texture), mipLevel: mip_level, origin });
const laidOut = ({ offset, bytes_per_row, rows_per_image }) => ({
    offset,
    bytesPerRow: bytes_per_row ?? undefined,
    rowsPerImage: rows_per_image ?? undefined,
});

// Repeats one recording. `load` gives a file of it as bytes; `planted` maps shaders. Resolves to what was compared.
export async function replay(browser, load, planted) {
    browser.device.pushErrorScope("validation");
    let result;
    try {
        result = await perform_all(browser, load, planted);
    } finally {
        const error = await browser.device.popErrorScope();
        if (error) throw new Error(error.message.split("\n")[0]);
    }
    return result;
}

async function perform_all(browser, load, planted) {
    const { device } = browser;
    const decoder = new TextDecoder();
    const actions = parseRon(decoder.decode(await load("trace.ron")));
    const result = { reads: 0, words: 0, different: 0, faults: [] };
    const things = new Map();
    const get = (pointer) => things.get(id(pointer)) ?? unknown(`object ${id(pointer)}`);
    // Data are asked for some actions before their turn: waiting for each alone takes a quarter of the time.
    const AHEAD = 64;
    let asked = 0;
    const ask = (end) => {
        for (; asked < Math.min(end, actions.length); asked++) {
            const [, content] = variant(actions[asked]);
            if (!content?.data) continue;
            const [kind, file] = variant(content.data);
            content.data = kind === "File" ? load(file[0]) : unknown(`data ${kind}`);
        }
    };
    // Pipelines that no submission waited for yet.
    const compiling = [];
    const allCompiled = () => Promise.all(compiling.splice(0));
    // Buffer of the last copy that was made to read it.
    let read;
    // What takes memory.
    const made = [];
    const make = (to, thing) => {
        things.set(id(to), thing);
        made.push(thing);
    };

    const perform = {
        CreateBuffer([to, { label, size, usage }]) {
            if (label === "expected") {
                things.set(id(to), { expected: true });
                return;
            }
            const flags = bits(usage, BUFFER_USAGE) | GPUBufferUsage.COPY_DST;
            make(to, device.createBuffer({ size: Math.ceil(size / 4) * 4, usage: flags }));
        },
        CreateTexture([to, { size, mip_level_count, dimension, format, usage }]) {
            const flags = bits(usage, TEXTURE_USAGE);
            const descriptor = { size, mipLevelCount: mip_level_count, dimension, format, usage: flags };
            make(to, device.createTexture(descriptor));
        },
        CreateTextureView({ id: to, parent, desc: { dimension, range } }) {
            const view = get(parent).createView({
                dimension: dimension ?? undefined,
                baseMipLevel: range.baseMipLevel,
                mipLevelCount: range.mipLevelCount ?? undefined,
                baseArrayLayer: range.baseArrayLayer,
                arrayLayerCount: range.arrayLayerCount ?? undefined,
            });
            things.set(id(to), view);
        },
        CreateBindGroupLayout([to, { entries }]) {
            things.set(id(to), { entries: entries.map(layoutEntry) });
        },
        async GetComputePipelineBindGroupLayout({ id: to, pipeline, index }) {
            await allCompiled();
            things.set(id(to), { layout: get(pipeline).pipeline.getBindGroupLayout(index) });
        },
        CreatePipelineLayout([to, { bind_group_layouts }]) {
            things.set(id(to), { groups: bind_group_layouts.map((layout) => get(layout).entries) });
        },
        CreateBindGroup([to, { layout, entries }]) {
            const resource = (content) => {
                const [kind, value] = variant(content);
                if (kind === "TextureView") return get(value[0]);
                if (kind !== "Buffer") return unknown(`resource ${kind}`);
                const { buffer, offset, size } = value[0];
                return { buffer: get(buffer), offset, size: size ?? undefined };
            };
            const known = get(layout);
            const group = device.createBindGroup({
                layout: known.layout ?? browser.layout(known.entries),
                entries: entries.map((entry) => ({ binding: entry.binding, resource: resource(entry.resource) })),
            });
            things.set(id(to), group);
        },
        async CreateShaderModule({ id: to, data: content }) {
            things.set(id(to), { code: planted(decoder.decode(await content)) });
        },
        CreateComputePipeline({ id: to, desc: { layout, stage } }) {
            const { code } = get(stage.module);
            const constants = constantsOf(stage);
            const groups = layout ? get(layout).groups : undefined;
            const thing = {};
            things.set(id(to), thing);
            const compiled = browser.pipeline(code, stage.entry_point ?? undefined, constants, groups);
            compiling.push(compiled.then((pipeline) => (thing.pipeline = pipeline)));
        },
        async WriteBuffer({ id: to, data: content, offset }) {
            const bytes = await content;
            const buffer = get(to);
            if (buffer.expected) await compare(bytes);
            else device.queue.writeBuffer(buffer, offset, bytes);
        },
        async WriteTexture({ to, data: content, layout, size }) {
            device.queue.writeTexture(copied(to, get), await content, laidOut(layout), size);
        },
        async Submit([, commands]) {
            await allCompiled();
            const encoder = device.createCommandEncoder();
            for (const command of commands) {
                const [kind, content] = variant(command);
                (encode[kind] ?? unknown(`command ${kind}`))(encoder, content);
            }
            device.queue.submit([encoder.finish()]);
        },
    };

    const encode = {
        CopyBufferToBuffer(encoder, { src, src_offset, dst, dst_offset, size }) {
            const to = get(dst);
            encoder.copyBufferToBuffer(get(src), src_offset, to, dst_offset, size ?? undefined);
            if (to.usage & GPUBufferUsage.MAP_READ) read = to;
        },
        CopyBufferToTexture(encoder, { src, dst, size }) {
            encoder.copyBufferToTexture({ buffer: get(src.buffer), ...laidOut(src.layout) }, copied(dst, get), size);
        },
        CopyTextureToBuffer(encoder, { src, dst, size }) {
            encoder.copyTextureToBuffer(copied(src, get), { buffer: get(dst.buffer), ...laidOut(dst.layout) }, size);
        },
        CopyTextureToTexture(encoder, { src, dst, size }) {
            encoder.copyTextureToTexture(copied(src, get), copied(dst, get), size);
        },
        ClearBuffer(encoder, { dst, offset, size }) {
            encoder.clearBuffer(get(dst), offset, size ?? undefined);
        },
        PushDebugGroup() {},
        PopDebugGroup() {},
        RunComputePass(encoder, { pass: { commands, dynamic_offsets } }) {
            const pass = encoder.beginComputePass();
            // Dynamic offsets of all bind groups lie in one list, in the order of the commands.
            let used = 0;
            for (const command of commands) {
                const [kind, content] = variant(command);
                switch (kind) {
                    case "SetPipeline":
                        pass.setPipeline(get(content[0]).pipeline);
                        break;
                    case "SetBindGroup": {
                        const offsets = dynamic_offsets.slice(used, used + content.num_dynamic_offsets);
                        used += offsets.length;
                        pass.setBindGroup(content.index, get(content.bind_group), offsets);
                        break;
                    }
                    case "DispatchWorkgroups":
                        pass.dispatchWorkgroups(...content[0]);
                        break;
                    case "DispatchWorkgroupsIndirect":
                        pass.dispatchWorkgroupsIndirect(get(content.buffer), content.offset);
                        break;
                    default:
                        unknown(`command ${kind} of a pass`);
                }
            }
            pass.end();
        },
    };

    async function compare(bytes) {
        await read.mapAsync(GPUMapMode.READ);
        const got = new Uint32Array(read.getMappedRange().slice(0));
        const expected = new Uint32Array(bytes);
        if (got.length !== expected.length) throw new Error(`${got.length} words read instead of ${expected.length}`);
        result.reads++;
        result.words += got.length;
        const hex = (word) => word.toString(16).padStart(8, "0");
        let different = 0;
        let first = "";
        for (let i = 0; i < got.length; i++) {
            if (got[i] === expected[i]) continue;
            if (different++ === 0) first = `word ${i} is ${hex(got[i])} instead of ${hex(expected[i])}`;
        }
        if (different > 0) {
            result.different += different;
            result.faults.push(`read ${result.reads}: ${different} of ${got.length}, ${first}`);
        }
        read.unmap();
    }

    for (const [index, action] of actions.entries()) {
        ask(index + AHEAD);
        const [kind, content] = variant(action);
        // What wgpu drops may still be used by commands that are submitted later.
        if (!kind.startsWith("Drop") && !kind.startsWith("Destroy") && kind !== "Init" && kind !== "FailedCommands") {
            await (perform[kind] ?? unknown(`action ${kind}`))(content);
        }
        // Its data go.
        actions[index] = undefined;
    }
    await allCompiled();
    made.forEach((thing) => thing.destroy());
    return result;
}
