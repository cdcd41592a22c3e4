// Starts `fragbuf lsp` for `.fragbuf` files.
//
// Input: the setting `fragbuf.command`. Output: a client of the language server, which also shows the WGSL files of fragbuf: the server has
// them as documents `fragbuf-template:…`. Nothing here knows the language.
const { window, workspace } = require("vscode");
const { LanguageClient } = require("vscode-languageclient/node");

let client;

exports.activate = async () => {
    const command = workspace.getConfiguration("fragbuf").get("command", "fragbuf");
    const server = { command, args: ["lsp"] };
    // A user file that is saved changes the diagnostics of the description that names it.
    const synchronize = { fileEvents: workspace.createFileSystemWatcher("**/*.wgsl") };
    client = new LanguageClient("fragbuf", "fragbuf", server, { documentSelector: [{ language: "fragbuf" }], synchronize });
    try {
        await client.start();
    } catch (error) {
        window.showErrorMessage(`\`${command} lsp\` does not start: ${error.message}. Set \`fragbuf.command\` to the program.`);
    }
};

exports.deactivate = () => client?.stop();
