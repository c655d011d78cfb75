// Runs Khronos' validator over files: node validate.mjs VALIDATOR FILE…, where VALIDATOR is the package's folder. Prints a line
// for each error and each kind of warning; exit status 1 if there was an error in any file.
import { createRequire } from "node:module";
import { readFile } from "node:fs/promises";
import path from "node:path";

const [folder, ...files] = process.argv.slice(2);
const validator = createRequire(import.meta.url)(folder);
const shown = 10; // errors of a file

let bad = 0, warnings = 0;
for (const file of files) {
    let issues;
    try {
        const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
            uri: path.basename(file),
            maxIssues: 0, // no limit
            externalResourceFunction: async (uri) => new Uint8Array(await readFile(path.resolve(path.dirname(file), decodeURIComponent(uri)))),
        });
        issues = report.issues;
    } catch (error) {
        issues = { numErrors: 1, numWarnings: 0, messages: [{ severity: 0, code: "UNREADABLE", message: String(error), pointer: "" }] };
    }
    const errors = issues.messages.filter((m) => m.severity === 0);
    for (const { code, message, pointer } of errors.slice(0, shown)) console.log(`${file}: error: ${pointer ?? ""}: ${message} (${code})`);
    if (errors.length > shown) console.log(`${file}: ${errors.length - shown} more errors`);
    const kinds = new Map();
    for (const { code, message } of issues.messages.filter((m) => m.severity === 1)) kinds.set(code, [...(kinds.get(code) ?? []), message]);
    for (const [code, messages] of kinds) console.log(`${file}: ${messages.length} × warning: ${messages[0]} (${code})`);
    bad += errors.length > 0;
    warnings += issues.numWarnings;
}
console.log(`${files.length} files: ${bad} with errors, ${warnings} warnings (glTF validator ${validator.version()})`);
process.exitCode = bad ? 1 : 0;
