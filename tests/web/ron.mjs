// Reader of RON, the notation in which wgpu records calls. Structs become objects, tuples and lists arrays, options
// their content or null; a variant with content becomes an object with its name as the only key, one without a string.

export function parseRon(text) {
    let at = 0;
    const token = /\s*(?:(r#[A-Za-z0-9_.+-]+|[A-Za-z_][A-Za-z0-9_]*)|(-?(?:0x[0-9a-fA-F_]+|[0-9][0-9_]*(?:\.[0-9]*)?(?:[eE][-+]?[0-9]+)?|inf|NaN))|("(?:[^"\\]|\\.)*")|([()[\]{}:,]))/y;
    function next() {
        token.lastIndex = at;
        const match = token.exec(text);
        if (!match) throw new Error(`RON at ${at}: ${text.slice(at, at + 60)}`);
        at = token.lastIndex;
        const [, name, number, string, mark] = match;
        return { name, number, string, mark };
    }
    function peek() {
        const before = at;
        const found = next();
        at = before;
        return found;
    }
    // Elements up to a closing mark.
    function elements(close, element) {
        const all = [];
        while (peek().mark !== close) {
            all.push(element());
            if (peek().mark === ",") next();
        }
        next();
        return all;
    }
    function fields() {
        const before = at;
        if (next().name !== undefined && peek().mark === ":") {
            at = before;
            return Object.fromEntries(
                elements(")", () => {
                    const key = next().name;
                    next();
                    return [key, value()];
                }),
            );
        }
        at = before;
        return elements(")", value);
    }
    function value() {
        const { name, number, string, mark } = next();
        if (string !== undefined) return JSON.parse(string.replace(/\\'/g, "'"));
        if (number !== undefined) return Number(number.replaceAll("_", ""));
        if (mark === "(") return fields();
        if (mark === "[") return elements("]", value);
        if (mark === "{") {
            return new Map(
                elements("}", () => {
                    const key = value();
                    next();
                    return [key, value()];
                }),
            );
        }
        if (name === "true" || name === "false") return name === "true";
        if (name === "None") return null;
        if (name === undefined) throw new Error(`RON at ${at}: ${text.slice(at, at + 60)}`);
        // Names that are not identifiers, such as 2d-array, are written r#2d-array.
        const plain = name.replace(/^r#/, "");
        if (peek().mark !== "(") return plain;
        next();
        const content = fields();
        return name === "Some" ? content[0] : { [plain]: content };
    }
    return value();
}

// The constants of a pipeline in the order of their names: wgpu records them in any.
export function constantsOf({ constants }) {
    const entries = constants instanceof Map ? [...constants] : Object.entries(constants);
    return Object.fromEntries(entries.sort(([a], [b]) => (a < b ? -1 : 1)));
}
