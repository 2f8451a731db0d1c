// The page's choices in its address, so that a link shows what its sender saw. Choices that are as they were at first
// are left out.

const controls = () => [...document.querySelectorAll("input[name=scene], input[name=method], select, input[type=range]")];
const key = (control) => control.name || control.id;
const value_of = (control) => (control.type !== "radio" || control.checked ? control.value : undefined);
const is_first = (control) => {
    if (control.type === "radio") return control.defaultChecked;
    if (control.type === "range") return control.value === control.defaultValue;
    return control.value === ([...control.options].find((option) => option.defaultSelected) ?? control.options[0]).value;
};

export function read_address() {
    const asked = new URLSearchParams(location.search);
    for (const control of controls()) {
        const value = asked.get(key(control));
        if (value === null) continue;
        if (control.type === "radio") control.checked ||= control.value === value;
        else if (control.type === "range" || [...control.options].some((option) => option.value === value)) control.value = value;
    }
}

export function write_address() {
    const address = new URL(location.href);
    for (const control of controls()) {
        const value = value_of(control);
        if (value === undefined) continue;
        if (is_first(control)) address.searchParams.delete(key(control));
        else address.searchParams.set(key(control), value);
    }
    history.replaceState(null, "", address);
}
