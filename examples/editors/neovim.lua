-- fragbuf in Neovim 0.11: copy this into `init.lua`.
vim.filetype.add({ extension = { fragbuf = "fragbuf" } })
vim.lsp.config("fragbuf", { cmd = { "fragbuf", "lsp" }, filetypes = { "fragbuf" } })
vim.lsp.enable("fragbuf")
